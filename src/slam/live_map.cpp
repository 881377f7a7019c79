// SPDX-License-Identifier: MIT
#include "slam/live_map.h"

#include <algorithm>
#include <cstdlib>

namespace dynslam {
namespace {

constexpr int kSameSurface = 2;  ///< cells

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
  for (const ChunkIndex index : scanned_) {
    const auto it = drawn_.find(index);
    waiting_.push_back(it != drawn_.end() ? it->second : DrawnChunk{index});
  }
  scanned_.clear();
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
  grid_.apply(scan.misses, hits_);
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
