// SPDX-License-Identifier: MIT
#include "plan/lone_posts.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>

namespace dynslam {
namespace {

bool stands_alone(const CellBitmap& occupied, CellIndex c, const PostSize& size) {
  for (int dy = -size.alone; dy <= size.alone; ++dy) {
    const bool beside = std::abs(dy) <= size.thick;
    for (int dx = -size.alone; dx <= size.alone; ++dx) {
      if (beside && dx == -size.thick) dx = size.thick + 1;
      if (occupied.test({c.x + dx, c.y + dy})) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<CellIndex> lone_posts(const CellBitmap& occupied, const CellBox& within, const PostSize& size) {
  std::vector<CellIndex> posts;
  const ChunkBox& box = occupied.box();
  const ChunkIndex low = chunk_of(within.min), high = chunk_of(within.max);
  for (int y = std::max(within.min.y, occupied.first().y);
       y <= std::min(within.max.y, occupied.first().y + occupied.rows() - 1); ++y) {
    const std::uint64_t* row = occupied.row(y - occupied.first().y);
    for (int chunk = std::max(low.x, box.min.x); chunk <= std::min(high.x, box.max.x); ++chunk) {
      for (std::uint64_t bits = row[chunk - box.min.x]; bits != 0; bits &= bits - 1) {
        const CellIndex c{chunk * kChunkSide + std::countr_zero(bits), y};
        if (c.x < within.min.x || c.x > within.max.x) continue;
        if (stands_alone(occupied, c, size)) posts.push_back(c);
      }
    }
  }
  return posts;
}

}  // namespace dynslam
