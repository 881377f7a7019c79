// SPDX-License-Identifier: MIT
#include "autopilot/frontier_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "grid/flood_fill.h"

namespace dynslam {
namespace {

constexpr CellTile kClear{};
/// Of a frontier that the robot is on its way to so much is left until it counts as seen: the rest of its
/// cells come and go while it drives.
constexpr double kRest = 0.5;
/// As many cells a gap between rays has at the most, whatever is asked for.
constexpr int kWidestGap = 4;

constexpr CellTile full_tile() {
  CellTile tile{};
  tile.fill(~std::uint64_t{0});
  return tile;
}
constexpr CellTile kFull = full_tile();

ChunkBox box_of_both(const ChunkBox& a, const ChunkBox& b) {
  ChunkBox both = a;
  if (!b.empty()) both.include(b.min), both.include(b.max);
  return both;
}

/// The chunks that have cells within `reach` of a cell in which the tiles differ.
ChunkBox chunks_near_difference(ChunkIndex index, const CellTile& a, const CellTile& b, int reach) {
  std::uint64_t columns = 0;
  int low = kChunkSide, high = -1;
  for (int r = 0; r < kChunkSide; ++r) {
    const std::uint64_t differs = a[static_cast<std::size_t>(r)] ^ b[static_cast<std::size_t>(r)];
    if (differs == 0) continue;
    columns |= differs;
    low = std::min(low, r);
    high = r;
  }
  if (columns == 0) return {};
  const CellIndex first = first_cell(index);
  const int left = std::countr_zero(columns), right = kChunkSide - 1 - std::countl_zero(columns);
  return {chunk_of({first.x + left - reach, first.y + low - reach}),
          chunk_of({first.x + right + reach, first.y + high + reach})};
}

void add(const ChunkBox& chunks, std::set<ChunkIndex>& due) {
  for (std::int32_t y = chunks.min.y; y <= chunks.max.y; ++y) {
    for (std::int32_t x = chunks.min.x; x <= chunks.max.x; ++x) due.insert({x, y});
  }
}

int cells_for(double length_m, double cell_size_m) {
  return std::clamp(static_cast<int>(std::ceil(length_m / cell_size_m - 1e-9)), 1, kMostDepth);
}

bool is_clear(const CellTile& tile) {
  return std::all_of(tile.begin(), tile.end(), [](std::uint64_t row) { return row == 0; });
}

CellTile common(const CellTile& a, const CellTile& b) {
  CellTile tile;
  for (std::size_t r = 0; r < tile.size(); ++r) tile[r] = a[r] & b[r];
  return tile;
}

CellTile both(const CellTile& a, const CellTile& b) {
  CellTile tile;
  for (std::size_t r = 0; r < tile.size(); ++r) tile[r] = a[r] | b[r];
  return tile;
}

CellTile without(const CellTile& a, const CellTile& b) {
  CellTile tile;
  for (std::size_t r = 0; r < tile.size(); ++r) tile[r] = a[r] & ~b[r];
  return tile;
}

}  // namespace

std::size_t FrontierMap::update(Time now, const GridSnapshot& map) {
  if (map.cell_size_m() != last_.cell_size_m()) {
    known_.clear();
    forgotten_.clear();
    forgotten_before_.clear();
    cells_.clear();
    last_ = {};
  }
  depth_ = cells_for(config_.least_depth_m, map.cell_size_m());
  within_ = std::min(static_cast<int>(config_.deep_within_m / map.cell_size_m() + 0.5), kBeside - 1);
  width_ = cells_for(config_.least_width_m, map.cell_size_m());
  gap_ = std::min((width_ - 1) / 2, kWidestGap);
  std::set<ChunkIndex> due;
  grow_old(now, due);
  const ChunkBox box = box_of_both(map.box(), last_.box());
  for (std::int32_t y = box.min.y; y <= box.max.y; ++y) {
    for (std::int32_t x = box.min.x; x <= box.max.x; ++x) {
      const Chunk* chunk = map.find({x, y});
      if (chunk != last_.find({x, y})) look_at({x, y}, chunk, due);
    }
  }
  for (const ChunkIndex index : due) redo(index);
  last_ = map;
  return due.size();
}

/// Most looks make cells surer of what they are: then nothing is due.
void FrontierMap::look_at(ChunkIndex index, const Chunk* chunk, std::set<ChunkIndex>& due) {
  Known now =
      chunk ? Known{cells_in_state(*chunk, CellState::kFree), cells_in_state(*chunk, CellState::kUnknown)}
            : Known{kClear, kFull};
  const Known& before = known(index);
  const CellTile not_occupied = both(before.free, before.unknown);
  const CellTile lost = without(now.unknown, both(not_occupied, forgotten(index)));
  if (!is_clear(lost)) forgotten_[index] = both(forgotten_[index], lost);
  now.unknown = without(now.unknown, forgotten(index));
  add(chunks_near_difference(index, now.free, before.free, width_ - 1 + over_gap()), due);
  add(chunks_near_difference(index, now.unknown, before.unknown, unknown_reach()), due);
  if (chunk) {
    known_[index] = now;
  } else {
    known_.erase(index);
  }
}

/// What was forgotten long enough ago is as the map has it.
void FrontierMap::grow_old(Time now, std::set<ChunkIndex>& due) {
  if (forgotten_since_ && now >= *forgotten_since_ && now - *forgotten_since_ < kForgotten) return;
  forgotten_since_ = now;
  const Tiles old = std::exchange(forgotten_before_, std::exchange(forgotten_, {}));
  for (const auto& [index, cells] : old) {
    const Chunk* chunk = last_.find(index);
    const auto at = known_.find(index);
    if (!chunk || at == known_.end()) continue;
    const CellTile back = without(cells, forgotten(index));
    const CellTile before = at->second.unknown;
    at->second.unknown = both(before, common(cells_in_state(*chunk, CellState::kUnknown), back));
    add(chunks_near_difference(index, at->second.unknown, before, unknown_reach()), due);
  }
}

CellTile FrontierMap::forgotten(ChunkIndex index) const {
  CellTile cells{};
  for (const Tiles* tiles : {&forgotten_, &forgotten_before_})
    if (const auto at = tiles->find(index); at != tiles->end()) cells = both(cells, at->second);
  return cells;
}

const FrontierMap::Known& FrontierMap::known(ChunkIndex index) const {
  static constexpr Known kNothing{kClear, kFull};
  const auto at = known_.find(index);
  return at == known_.end() ? kNothing : at->second;
}

ChunkWindow FrontierMap::around(ChunkIndex index, CellTile Known::*cells) const {
  ChunkWindow window;
  for (int dy = 0; dy < 3; ++dy) {
    for (int dx = 0; dx < 3; ++dx) {
      const CellTile& tile = known({index.x + dx - 1, index.y + dy - 1}).*cells;
      for (int r = 0; r < kChunkSide; ++r)
        window[static_cast<std::size_t>(dy * kChunkSide + r)][static_cast<std::size_t>(dx)] =
            tile[static_cast<std::size_t>(r)];
    }
  }
  return window;
}

/// Where a square fits in, and beside that over gaps.
ChunkWindow FrontierMap::wide_free(ChunkIndex index, const ChunkWindow& unknown) const {
  ChunkWindow wide = around(index, &Known::free);
  ChunkWindow with_gaps = wide, no_gap = unknown;
  keep_deep(no_gap, gap_ + 1);
  add_without(with_gaps, unknown, no_gap);
  keep_deep(with_gaps, width_);
  keep_deep(wide, width_);
  grow(wide, with_gaps, over_gap());
  return wide;
}

void FrontierMap::redo(ChunkIndex index) {
  cells_.erase(index);
  const CellTile& all_free = known(index).free;
  if (is_clear(all_free)) return;
  ChunkWindow unknown = around(index, &Known::unknown);
  if (is_clear(common(all_free, beside(unknown)))) return;
  const ChunkWindow free = wide_free(index, unknown);
  ChunkWindow rim = unknown;
  keep_deep(rim, width_);
  keep_deep(unknown, depth_);
  grow(unknown, rim, within_);
  const CellTile cells = common(common(all_free, middle_of(free)), beside(unknown));
  if (!is_clear(cells)) cells_[index] = cells;
}

std::vector<Frontier> FrontierMap::frontiers(bool last_look) const {
  ExplorationConfig config = config_;
  if (last_look) config.least_length_m = std::min(config.least_length_m, config.last_look_length_m);
  ExplorationConfig with_rests = config;
  with_rests.least_length_m *= kRest;
  with_rests.least_extent_m *= kRest;
  std::vector<Frontier> found = find_frontiers(cells(), last_.cell_size_m(), with_rests);
  for (Frontier& f : found) {
    const double length_m = static_cast<double>(f.cells) * last_.cell_size_m();
    f.is_rest = length_m < config.least_length_m - 1e-9 || f.extent_m < config.least_extent_m - 1e-9;
    f.is_short = !f.is_rest && length_m < config_.least_length_m - 1e-9;
  }
  return found;
}

double FrontierMap::beyond_m2(const Frontier& frontier) const {
  const CellIndex middle = cell_at(frontier.middle_map, last_.cell_size_m());
  const ChunkIndex index = chunk_of(middle);
  ChunkWindow unknown = around(index, &Known::unknown);
  keep_deep(unknown, depth_);
  CellBitmap deep;
  deep.reset({{index.x - 1, index.y - 1}, {index.x + 1, index.y + 1}});
  for (int r = 0; r < deep.rows(); ++r)
    std::copy_n(unknown[static_cast<std::size_t>(r)].begin(), deep.words_per_row(), deep.row(r));
  std::vector<CellIndex> beside;
  for (int dy = -within_ - 1; dy <= within_ + 1; ++dy) {
    for (int dx = -within_ - 1; dx <= within_ + 1; ++dx) beside.push_back({middle.x + dx, middle.y + dy});
  }
  return static_cast<double>(flood_fill(deep, beside).count()) * last_.cell_size_m() * last_.cell_size_m();
}

bool FrontierMap::is_frontier(CellIndex c) const {
  const auto at = cells_.find(chunk_of(c));
  return at != cells_.end() &&
         (at->second[static_cast<std::size_t>(c.y & kChunkMask)] >> (c.x & kChunkMask) & 1U) != 0;
}

std::vector<CellIndex> FrontierMap::cells() const {
  std::vector<CellIndex> cells;
  for (auto first = cells_.begin(); first != cells_.end();) {
    const auto last = cells_.lower_bound({std::numeric_limits<std::int32_t>::min(), first->first.y + 1});
    for (int r = 0; r < kChunkSide; ++r) {
      for (auto at = first; at != last; ++at) {
        const CellIndex corner = first_cell(at->first);
        for (std::uint64_t row = at->second[static_cast<std::size_t>(r)]; row != 0; row &= row - 1)
          cells.push_back({corner.x + std::countr_zero(row), corner.y + r});
      }
    }
    first = last;
  }
  return cells;
}

}  // namespace dynslam
