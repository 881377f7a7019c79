// SPDX-License-Identifier: MIT
#include "slam/live_map.h"

#include <algorithm>
#include <cstdlib>

#include "grid/bitmap_sets.h"
#include "grid/flood_fill.h"

namespace dynslam {
namespace {

constexpr int kSameSurface = 2;         ///< cells; a hit is of a drawn surface that is so near
constexpr int kBeyond = 1;              ///< cells; a surface is gone when so much behind it is seen
constexpr std::uint8_t kClearly = 128;  ///< two looks at the least

/// Whether the words of a bitmap in one chunk hold anything.
bool any_in(const CellBitmap& cells, ChunkIndex chunk) {
  const int row = (chunk.y - cells.box().min.y) * kChunkSide, word = chunk.x - cells.box().min.x;
  std::uint64_t any = 0;
  for (int r = 0; r < kChunkSide; ++r) any |= cells.row(row + r)[word];
  return any != 0;
}

}  // namespace

void LiveMap::redrawn(std::span<const DrawnChunk> chunks) {
  for (const DrawnChunk& c : chunks) {
    drawn_[c.index] = c;
    scanned_.insert(c.index);
  }
  for (const ChunkIndex index : scanned_) waiting_.push_back(with_recent(index));
  scanned_.clear();
  forget_recent();
}

void LiveMap::settle(std::span<const DrawnChunk> chunks) {
  forget_recent();
  waiting_.clear();
  for (const DrawnChunk& c : chunks) drawn_[c.index] = c;
  for (std::int32_t y = grid_.box().min.y; y <= grid_.box().max.y; ++y) {
    for (std::int32_t x = grid_.box().min.x; x <= grid_.box().max.x; ++x) {
      if (grid_.find({x, y}) && !drawn_.contains({x, y})) grid_.show({x, y}, {}, {});
    }
  }
  for (const auto& [index, c] : drawn_) grid_.show(index, c.free, c.occupied);
}

void LiveMap::forget_recent() {
  recent_ = ChunkedGrid(grid_.cell_size_m(), recent_.max_chunks(), kRecentRule);
}

/// What the back end drew, and what the scans since the last time say against it.
DrawnChunk LiveMap::with_recent(ChunkIndex index) const {
  const auto it = drawn_.find(index);
  DrawnChunk out = it != drawn_.end() ? it->second : DrawnChunk{index};
  const Chunk* seen = recent_.find(index);
  if (!seen) return out;
  const CellIndex first = first_cell(index);
  for (int y = 0; y < kChunkSide; ++y) {
    const auto row = static_cast<std::size_t>(y);
    for (int x = 0; x < kChunkSide; ++x) {
      const std::uint64_t bit = std::uint64_t{1} << x;
      const std::uint8_t hit = seen->hit[y][x], miss = seen->miss[y][x];
      const CellState state = cell_state(hit, miss);
      if (state == CellState::kFree && miss >= kClearly) {
        out.free[row] |= bit;
        out.occupied[row] &= ~bit;
      } else if (state == CellState::kOccupied && hit >= kClearly) {
        const CellIndex cell{first.x + x, first.y + y};
        if (surface_near(cell) != cell) continue;
        out.occupied[row] |= bit;
        out.free[row] &= ~bit;
      }
    }
  }
  return out;
}

void LiveMap::show(std::size_t most_chunks) {
  for (; most_chunks > 0 && !waiting_.empty(); --most_chunks) {
    const DrawnChunk& c = waiting_.front();
    grid_.show(c.index, c.free, c.occupied);
    waiting_.pop_front();
  }
}

void LiveMap::draw(const ScanFootprint& scan) {
  const ChunkBox& box = scan.misses.box();
  for (std::int32_t y = box.min.y; y <= box.max.y; ++y) {
    for (std::int32_t x = box.min.x; x <= box.max.x; ++x) {
      if (any_in(scan.misses, {x, y})) scanned_.insert({x, y});
    }
  }
  hits_.clear();
  for (const CellIndex c : scan.hits) {
    hits_.push_back(surface_near(c));
    scanned_.insert(chunk_of(hits_.back()));
  }
  std::sort(hits_.begin(), hits_.end());
  hits_.erase(std::unique(hits_.begin(), hits_.end()), hits_.end());
  const CellBitmap misses = sparing_surfaces(scan.misses);
  grid_.apply(misses, hits_);
  recent_.apply(misses, hits_);
}

/// What is seen aslant is off by a cell or two, and would eat walls. What is gone is missed with all around
/// it.
CellBitmap LiveMap::sparing_surfaces(const CellBitmap& misses) const {
  const CellBitmap wide = shrunk_all_round(misses, kBeyond);
  CellBitmap spared = misses;
  for (std::int32_t y = misses.box().min.y; y <= misses.box().max.y; ++y) {
    for (std::int32_t x = misses.box().min.x; x <= misses.box().max.x; ++x) {
      const Chunk* chunk = grid_.find({x, y});
      if (!chunk || !any_in(misses, {x, y})) continue;
      const CellTile surfaces = cells_in_state(*chunk, CellState::kOccupied);
      CellTile here = misses.tile({x, y});
      const CellTile there = wide.tile({x, y});
      for (std::size_t r = 0; r < here.size(); ++r) here[r] &= ~surfaces[r] | there[r];
      spared.put({x, y}, here);
    }
  }
  return spared;
}

bool LiveMap::is_surface(CellIndex c) const {
  const auto it = drawn_.find(chunk_of(c));
  return it != drawn_.end() &&
         ((it->second.occupied[static_cast<std::size_t>(c.y & kChunkMask)] >> (c.x & kChunkMask)) & 1U) != 0;
}

/// The nearest cell of a drawn surface, or the hit's own.
CellIndex LiveMap::surface_near(CellIndex hit) const {
  for (int reach = 0; reach <= kSameSurface; ++reach) {
    for (int dy = -reach; dy <= reach; ++dy) {
      const int dx = reach - std::abs(dy);
      if (is_surface({hit.x - dx, hit.y + dy})) return {hit.x - dx, hit.y + dy};
      if (dx != 0 && is_surface({hit.x + dx, hit.y + dy})) return {hit.x + dx, hit.y + dy};
    }
  }
  return hit;
}

}  // namespace dynslam
