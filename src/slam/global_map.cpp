// SPDX-License-Identifier: MIT
#include "slam/global_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "grid/bitmap_sets.h"
#include "grid/cell_bitmap.h"
#include "slam/clean_up.h"
#include "slam/witness.h"

namespace dynslam {
namespace {

constexpr double kBlock_m = 0.5;
/// A map is named where it shows at least this share of a block; a cell of a surface counts for so many of
/// free space.
constexpr double kLeastShown = 0.02;
constexpr int kSurfaceWorth = 4;
/// Free space narrower than this many cells, with no way to wider parts, is the gap between two drawings of
/// one wall.
constexpr int kGap = 8;
/// Cells in doubt in the midst of free space, as there are beside walls, are no wider, corner to corner.
constexpr int kCrack = 6;

/// The power of two nearest to half a metre, from 8 to 32 cells.
int block_bits_for(double cell_size_m) {
  const double bits = std::log2(kBlock_m / cell_size_m);
  return static_cast<int>(std::clamp(std::lround(bits), 3L, 5L));
}

/// Whether any cell of a square of a tile is set.
bool any_in(const CellTile& tile, int x, int y, int side) {
  const std::uint64_t columns =
      side == kChunkSide ? ~std::uint64_t{0} : ((std::uint64_t{1} << side) - 1) << x;
  std::uint64_t any = 0;
  for (int r = y; r < y + side; ++r) any |= tile[static_cast<std::size_t>(r)] & columns;
  return any != 0;
}

/// Puts blocks in order and drops those that are there more than once. They lie close together: in a bitmap,
/// with x and y exchanged as its rows come first in the order, that takes no comparing.
void sort_each_once(std::vector<CellIndex>& blocks) {
  ChunkBox box;
  for (const CellIndex b : blocks) box.include(chunk_of({b.y, b.x}));
  CellBitmap marks;
  marks.reset(box);
  for (const CellIndex b : blocks) marks.set({b.y, b.x});
  blocks.clear();
  for (int r = 0; r < marks.rows(); ++r) {
    for (int w = 0; w < marks.words_per_row(); ++w) {
      for (std::uint64_t left = marks.row(r)[w]; left != 0; left &= left - 1)
        blocks.push_back({marks.first().y + r, marks.first().x + w * kChunkSide + std::countr_zero(left)});
    }
  }
}

/// Writes the rows of a block into the chunk around it.
void put(CellTile& tile, CellIndex first, const BlockView::Rows& rows, int side) {
  const int shift = first.x & kChunkMask, low = first.y & kChunkMask;
  const std::uint64_t columns = ((std::uint64_t{1} << side) - 1) << shift;
  for (int y = 0; y < side; ++y) {
    std::uint64_t& word = tile[static_cast<std::size_t>(low + y)];
    word = (word & ~columns) | std::uint64_t{rows[static_cast<std::size_t>(y)]} << shift;
  }
}

}  // namespace

GlobalMap::GlobalMap(double cell_size_m)
    : cell_size_m_(cell_size_m), block_bits_(block_bits_for(cell_size_m)) {}

void GlobalMap::place(std::shared_ptr<const FinishedMap> map, const Pose2& map_T_origin) {
  const std::uint32_t id = map->id;
  Placed& placed = maps_[id] = {std::move(map), map_T_origin, {}};
  name_in(id, placed, blocks_under(placed));
}

void GlobalMap::place_for_now(std::shared_ptr<const FinishedMap> map, const Pose2& map_T_origin) {
  passing_ = map->id;
  place(std::move(map), map_T_origin);
}

void GlobalMap::move(const std::map<std::uint32_t, Pose2>& map_T_origins) {
  const double least_m = 0.25 * cell_size_m_;
  for (auto& [id, placed] : maps_) {
    const auto to = map_T_origins.find(id);
    if (to == map_T_origins.end()) continue;
    const Pose2 step = placed.map_T_origin.inverse() * to->second;
    // A turn moves what is five metres away the most that matters.
    if (step.translation().norm() + 5.0 * std::abs(step.yaw) >= least_m) move_to(id, placed, to->second);
  }
}

/// Names a map in the blocks where those lie now that named it before.
void GlobalMap::move_to(std::uint32_t id, Placed& placed, const Pose2& map_T_origin) {
  const Pose2 after_T_before = map_T_origin * placed.map_T_origin.inverse();
  placed.map_T_origin = map_T_origin;
  const double half = 0.5 * block_cells(), reach = half * (std::abs(std::cos(after_T_before.yaw)) +
                                                           std::abs(std::sin(after_T_before.yaw)));
  BlockSet after;
  for (const CellIndex b : placed.blocks) {
    const Vector2 middle = cell_size_m_ * Vector2(b.x * 2 * half + half, b.y * 2 * half + half);
    append_under_square(after_T_before * middle / cell_size_m_, reach, after);
  }
  name_in(id, placed, std::move(after));
}

void GlobalMap::remove(std::uint32_t id) {
  const auto it = maps_.find(id);
  if (it == maps_.end()) return;
  for (const CellIndex b : it->second.blocks) unname(b, id);
  maps_.erase(it);
  if (passing_ == id) passing_.reset();
}

void GlobalMap::touch(CellIndex index, Block& block) {
  if (std::exchange(block.dirty, true)) return;
  dirty_.push_back(index);
}

/// The block's side of naming a map: it is drawn again in any case.
void GlobalMap::name(CellIndex index, std::uint32_t id) {
  Block& block = blocks_[index];
  const auto at = std::lower_bound(block.ids.begin(), block.ids.end(), id, std::greater<>());
  if (at == block.ids.end() || *at != id) block.ids.insert(at, id);
  touch(index, block);
}

/// The block's side of taking a name out.
void GlobalMap::unname(CellIndex index, std::uint32_t id) {
  Block& block = blocks_.at(index);
  std::erase(block.ids, id);
  touch(index, block);
}

/// Names a map in some blocks, in any order, and no longer in any other.
void GlobalMap::name_in(std::uint32_t id, Placed& placed, BlockSet blocks) {
  sort_each_once(blocks);
  for (const CellIndex b : blocks) name(b, id);
  BlockSet left;
  std::set_difference(placed.blocks.begin(), placed.blocks.end(), blocks.begin(), blocks.end(),
                      std::back_inserter(left));
  for (const CellIndex b : left) unname(b, id);
  placed.blocks = std::move(blocks);
}

/// Appends all blocks that a square reaches into.
void GlobalMap::append_under_square(const Vector2& centre_cells, double half_width_cells,
                                    BlockSet& blocks) const {
  constexpr double kHair = 0.01;  // of a block: a square that fits a block is in no other
  const double reach = half_width_cells / block_cells() - kHair;
  const Vector2 centre = centre_cells / block_cells();
  const CellIndex low = cell_at(centre - Vector2(reach, reach), 1.0),
                  high = cell_at(centre + Vector2(reach, reach), 1.0);
  for (std::int32_t y = low.y; y <= high.y; ++y) {
    for (std::int32_t x = low.x; x <= high.x; ++x) blocks.push_back({x, y});
  }
}

/// The blocks in which a map knows anything, some of them more than once.
GlobalMap::BlockSet GlobalMap::blocks_under(const Placed& placed) const {
  const FinishedMap& map = *placed.map;
  const Pose2 map_T_drawn = placed.map_T_origin * map.drawn_T_origin.inverse();
  const int side = block_cells();
  const double reach =
      0.5 * side * (std::abs(std::cos(map_T_drawn.yaw)) + std::abs(std::sin(map_T_drawn.yaw)));
  ChunkBox all = map.free.box();
  if (!map.occupied.empty()) {
    all.include(map.occupied.box().min);
    all.include(map.occupied.box().max);
  }
  BlockSet blocks;
  for (std::int32_t cy = all.min.y; cy <= all.max.y; ++cy) {
    for (std::int32_t cx = all.min.x; cx <= all.max.x; ++cx) {
      const CellTile &free = map.free.tile({cx, cy}), &occupied = map.occupied.tile({cx, cy});
      for (int y = 0; y < kChunkSide; y += side) {
        for (int x = 0; x < kChunkSide; x += side) {
          if (!any_in(free, x, y, side) && !any_in(occupied, x, y, side)) continue;
          const Vector2 middle(cx * kChunkSide + x + 0.5 * side, cy * kChunkSide + y + 0.5 * side);
          append_under_square(map_T_drawn * Vector2(middle * cell_size_m_) / cell_size_m_, reach, blocks);
        }
      }
    }
  }
  return blocks;
}

std::size_t GlobalMap::redraw(std::size_t most_blocks) {
  for (; most_blocks > 0 && !dirty_.empty(); --most_blocks) {
    const auto it = blocks_.find(dirty_.front());
    dirty_.pop_front();
    it->second.dirty = false;
    draw(it->first, it->second);
    if (it->second.ids.empty()) blocks_.erase(it);
  }
  return dirty_.size();
}

/// Hears the maps that a block names, newest first. Those that add too little are not heard, and their names
/// taken out.
void GlobalMap::draw(CellIndex index, Block& block) {
  const int side = block_cells();
  BlockView view({index.x * side, index.y * side}, side);
  const double least = kLeastShown * side * side;
  const bool keep_names = passing_ && !block.ids.empty() && block.ids.front() == *passing_;
  std::erase_if(block.ids, [&](std::uint32_t id) {
    Placed& placed = maps_.at(id);
    BlockView with_it = view;
    Testimony said;
    if (!view.is_decided()) said = hear(*placed.map, placed.map_T_origin, with_it);
    const bool shows = said.free + kSurfaceWorth * said.occupied >= least;
    if (shows) view = with_it;
    if (shows || keep_names) return false;
    placed.blocks.erase(std::lower_bound(placed.blocks.begin(), placed.blocks.end(), index));
    return true;
  });
  const ChunkIndex chunk = chunk_of(view.first);
  DrawnChunk& drawn = pictures_[chunk].drawn;
  drawn.index = chunk;
  put(drawn.free, view.first, view.free, side);
  put(drawn.occupied, view.first, view.occupied, side);
}

/// Of all chunks, and a rim of one more, so that nothing is grown against its edge.
ChunkBox GlobalMap::box() const {
  ChunkBox box;
  for (const auto& [chunk, picture] : pictures_) {
    box.include({chunk.x - 1, chunk.y - 1});
    box.include({chunk.x + 1, chunk.y + 1});
  }
  return box;
}

std::vector<DrawnChunk> GlobalMap::publish() {
  CellBitmap free, occupied;
  free.reset(box());
  occupied.reset(box());
  for (const auto& [chunk, picture] : pictures_) {
    free.put(chunk, picture.drawn.free);
    occupied.put(chunk, picture.drawn.occupied);
  }
  mend_walls(occupied, free);
  fill_cracks(free, occupied, kCrack);
  drop_gaps(free, occupied, kGap);
  std::vector<DrawnChunk> changed;
  for (auto& [chunk, picture] : pictures_) {
    const DrawnChunk now{chunk, free.tile(chunk), occupied.tile(chunk)};
    if (now.free == picture.shown.free && now.occupied == picture.shown.occupied) continue;
    picture.shown = now;
    changed.push_back(now);
  }
  return changed;
}

std::vector<std::uint32_t> GlobalMap::retire(std::uint32_t keep) {
  std::vector<std::uint32_t> retired;
  for (auto it = maps_.begin(); it != maps_.end() && it->first < keep;) {
    if (it->second.blocks.empty()) {
      retired.push_back(it->first);
      it = maps_.erase(it);
    } else {
      ++it;
    }
  }
  return retired;
}

std::optional<Time> GlobalMap::last_seen(CellIndex cell) const {
  const auto it = blocks_.find({cell.x >> block_bits_, cell.y >> block_bits_});
  if (it == blocks_.end() || it->second.ids.empty()) return std::nullopt;
  return maps_.at(it->second.ids.front()).map->ended;
}

std::size_t GlobalMap::names() const {
  std::size_t n = 0;
  for (const auto& [index, block] : blocks_) n += block.ids.size();
  return n;
}

}  // namespace dynslam
