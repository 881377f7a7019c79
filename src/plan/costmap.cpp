// SPDX-License-Identifier: MIT
#include "plan/costmap.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "plan/lone_posts.h"
#include "plan/outline_cells.h"

namespace dynslam {
namespace {

std::size_t area_of(const ChunkBox& box) {
  return static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height());
}

bool holds(const ChunkBox& box, ChunkIndex c) {
  return c.x >= box.min.x && c.x <= box.max.x && c.y >= box.min.y && c.y <= box.max.y;
}

template <class Visit>
void for_each_chunk(const ChunkBox& box, Visit&& visit) {
  for (std::int32_t y = box.min.y; y <= box.max.y; ++y) {
    for (std::int32_t x = box.min.x; x <= box.max.x; ++x) visit(ChunkIndex{x, y});
  }
}

/// The box to cover for a map: all of it, unless that is too much.
ChunkBox box_for(const ChunkBox& map, const ChunkBox& before) {
  if (map.empty()) return before;
  ChunkBox box = before;
  box.include(map.min);
  box.include(map.max);
  if (area_of(box) <= Costmap::kMostChunks) return box;
  if (!before.empty()) return before;
  constexpr std::int32_t kHalf = 64;  // about the origin, where a map begins
  static_assert(4 * kHalf * kHalf == Costmap::kMostChunks);
  return {{std::clamp(map.min.x, -kHalf, kHalf - 1), std::clamp(map.min.y, -kHalf, kHalf - 1)},
          {std::clamp(map.max.x, -kHalf, kHalf - 1), std::clamp(map.max.y, -kHalf, kHalf - 1)}};
}

CellBitmap over(const ChunkBox& box, const CellBitmap& cells) {
  CellBitmap wider;
  wider.reset(box);
  for_each_chunk(cells.box(), [&](ChunkIndex c) { wider.put(c, cells.tile(c)); });
  return wider;
}

/// The rectangle around the cells that differ.
struct Extent {
  int left, right, low, high;
};

std::optional<Extent> difference(const CellTile& before, const CellTile& after) {
  std::uint64_t columns = 0;
  int low = kChunkSide, high = -1;
  for (int r = 0; r < kChunkSide; ++r) {
    const std::uint64_t differ = before[static_cast<std::size_t>(r)] ^ after[static_cast<std::size_t>(r)];
    if (differ == 0) continue;
    columns |= differ;
    low = std::min(low, r);
    high = r;
  }
  if (columns == 0) return std::nullopt;
  return Extent{std::countr_zero(columns), kChunkSide - 1 - std::countl_zero(columns), low, high};
}

/// The cells of a coarse cell, from its middle out.
constexpr int kFromTheMiddle[] = {5, 6, 9, 10, 1, 2, 4, 7, 8, 11, 13, 14, 0, 3, 12, 15};

}  // namespace

Costmap::Costmap(double cell_size_m) : cell_size_m_(cell_size_m), chunk_clearance_(cell_size_m, kReach_m) {}

std::size_t Costmap::update(const GridSnapshot& map) {
  cover(map.box());
  for_each_chunk(box(), [&](ChunkIndex c) { take_in(c, map.find(c)); });
  if (forbidden_is_stale_) draw_forbidden();
  std::size_t computed = 0;
  for_each_chunk(box(), [&](ChunkIndex c) {
    std::uint8_t& stale = stale_[place_of(c)];
    if (stale & kClearance) {
      refresh_clearance(c);
      ++computed;
    }
    if (stale != 0) {
      refresh_coarse(c);
      mark_posts(c);
    }
    stale = 0;
  });
  return computed;
}

void Costmap::set_forbidden(std::span<const std::vector<Vector2>> outlines_map) {
  outlines_.clear();
  std::size_t corners = 0;
  for (const auto& outline : outlines_map) {
    if (outline.size() > kMostCorners - corners) continue;
    corners += outline.size();
    outlines_.push_back(outline);
  }
  forbidden_is_stale_ = true;
}

void Costmap::cover(const ChunkBox& wanted) {
  const ChunkBox before = box(), after = box_for(wanted, before);
  if (after.min == before.min && after.max == before.max) return;
  std::vector<std::unique_ptr<ClearanceTile>> tiles(area_of(after));
  std::vector<Seen> seen(area_of(after));
  std::vector<std::uint8_t> stale(area_of(after), kClearance | kCoarse);
  const auto place_after = [&](ChunkIndex c) {
    return static_cast<std::size_t>(c.y - after.min.y) * static_cast<std::size_t>(after.width()) +
           static_cast<std::size_t>(c.x - after.min.x);
  };
  for_each_chunk(before, [&](ChunkIndex c) {
    tiles[place_after(c)] = std::move(tiles_[place_of(c)]);
    seen[place_after(c)] = seen_[place_of(c)];
    stale[place_after(c)] = stale_[place_of(c)];
  });
  for (CellBitmap* cells : {&occupied_, &known_, &forbidden_}) *cells = over(after, *cells);
  tiles_ = std::move(tiles);
  seen_ = std::move(seen);
  stale_ = std::move(stale);
  coarse_.cover(after);
  forbidden_is_stale_ = forbidden_is_stale_ || !outlines_.empty();
}

void Costmap::take_in(ChunkIndex index, const Chunk* chunk) {
  Seen& seen = seen_[place_of(index)];
  const Seen now{chunk, chunk ? chunk->version : 0};
  if (now.chunk == seen.chunk && now.version == seen.version) return;
  seen = now;
  const CellStates states = chunk ? states_of(*chunk) : CellStates{};
  mark_near(index, occupied_.tile(index), states.occupied);
  occupied_.put(index, states.occupied);
  if (known_.tile(index) == states.known) return;
  known_.put(index, states.known);
  stale_[place_of(index)] |= kCoarse;
}

void Costmap::draw_forbidden() {
  const CellBitmap before = std::move(forbidden_);
  forbidden_.reset(box());
  for (const auto& outline : outlines_) add_inside(outline, cell_size_m_, forbidden_);
  for_each_chunk(box(), [&](ChunkIndex c) { mark_near(c, before.tile(c), forbidden_.tile(c)); });
  forbidden_is_stale_ = false;
}

/// Marks what a difference between two sets of a chunk's blocked cells can reach.
void Costmap::mark_near(ChunkIndex index, const CellTile& before, const CellTile& after) {
  const auto differ = difference(before, after);
  if (!differ) return;
  const CellIndex first = first_cell(index);
  const int reach = chunk_clearance_.reach_cells();
  const ChunkIndex low = chunk_of({first.x + differ->left - reach, first.y + differ->low - reach});
  const ChunkIndex high = chunk_of({first.x + differ->right + reach, first.y + differ->high + reach});
  for_each_chunk({low, high}, [&](ChunkIndex c) {
    if (holds(box(), c)) stale_[place_of(c)] |= kClearance;
  });
}

void Costmap::refresh_clearance(ChunkIndex index) {
  std::unique_ptr<ClearanceTile>& tile = tiles_[place_of(index)];
  if (!tile) tile = std::make_unique<ClearanceTile>();
  if (!chunk_clearance_.compute(occupied_, forbidden_, index, *tile)) tile.reset();
}

void Costmap::refresh_coarse(ChunkIndex index) {
  const ClearanceTile* tile = tiles_[place_of(index)].get();
  const CellTile known = known_.tile(index);
  const CellIndex first = first_cell(index);
  for (std::size_t y = 0; y < kChunkSide; y += kCoarseSide) {
    const std::size_t row = coarse_.index_of({first.x, first.y + static_cast<int>(y)});
    for (std::size_t x = 0; x < kChunkSide; x += kCoarseSide) {
      int count = 0;
      for (std::size_t r = y; r < y + kCoarseSide; ++r) count += std::popcount((known[r] >> x) & 15U);
      int best = kFromTheMiddle[0];
      std::uint8_t most = chunk_clearance_.most();
      if (tile) {
        const auto at = [&](int i) {
          return (*tile)[y + static_cast<std::size_t>(i / kCoarseSide)]
                        [x + static_cast<std::size_t>(i % kCoarseSide)];
        };
        most = at(best);
        for (const int i : kFromTheMiddle) {
          if (at(i) > most) best = i, most = at(i);
        }
      }
      const bool is_known = count >= kCoarseSide * kCoarseSide / 2;
      CoarseCell& cell = coarse_[row + x / kCoarseSide];
      cell.clearance = most;
      cell.about = static_cast<std::uint8_t>(best | (is_known ? CoarseCell::kKnown : 0));
      if (is_known) cell.once = std::max(cell.once, most);
    }
  }
}

void Costmap::mark_posts(ChunkIndex index) {
  constexpr double kPostThick_m = 0.1, kPostAlone_m = 0.3;
  const auto cells = [&](double m) { return static_cast<int>(m / cell_size_m_); };
  const int berth = std::min(cells(kPostBerth_m), chunk_clearance_.reach_cells() - cells(kPostAlone_m));
  const CellIndex first = first_cell(index);
  const CellBox near{{first.x - berth, first.y - berth},
                     {first.x + kChunkSide - 1 + berth, first.y + kChunkSide - 1 + berth}};
  const PostSize size{std::min(kMostAlone, cells(kPostThick_m)), std::min(kMostAlone, cells(kPostAlone_m))};
  for (const CellIndex post : lone_posts(occupied_, near, size)) {
    for (int y = 0; y < kChunkSide; y += kCoarseSide) {
      for (int x = 0; x < kChunkSide; x += kCoarseSide) {
        const double dx = first.x + x + 0.5 * kCoarseSide - post.x,
                     dy = first.y + y + 0.5 * kCoarseSide - post.y;
        if (dx * dx + dy * dy > double(berth) * berth) continue;
        coarse_[coarse_.index_of({first.x + x, first.y + y})].about |= CoarseCell::kByPost;
      }
    }
  }
}

bool Costmap::contains(const Vector2& p) const {
  const double side_m = kChunkSide * cell_size_m_;
  return p.x() >= box().min.x * side_m && p.x() < (box().max.x + 1) * side_m &&
         p.y() >= box().min.y * side_m && p.y() < (box().max.y + 1) * side_m &&
         contains(cell_at(p, cell_size_m_));
}

double Costmap::clearance_m(const Vector2& point_map) const {
  if (!point_map.allFinite()) return 0.0;
  if (!contains(point_map)) return kReach_m;
  return clearance_steps(cell_at(point_map, cell_size_m_)) * kClearanceStep_m;
}

CellState Costmap::state(const Vector2& point_map) const {
  if (!contains(point_map)) return CellState::kUnknown;
  const CellIndex c = cell_at(point_map, cell_size_m_);
  if (is_occupied(c) || is_forbidden(c)) return CellState::kOccupied;
  return is_known(c) ? CellState::kFree : CellState::kUnknown;
}

}  // namespace dynslam
