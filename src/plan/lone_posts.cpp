// SPDX-License-Identifier: MIT
#include "plan/lone_posts.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace dynslam {
namespace {

/// 64 cells of a row, from `c` to the right; those outside are clear.
std::uint64_t cells_from(const CellBitmap& occupied, CellIndex c) {
  const int row = c.y - occupied.first().y, words = occupied.words_per_row();
  if (row < 0 || row >= occupied.rows()) return 0;
  const int word = (c.x >> kChunkBits) - occupied.box().min.x, shift = c.x & kChunkMask;
  const auto at = [&](int w) { return w >= 0 && w < words ? occupied.row(row)[w] : 0; };
  return shift == 0 ? at(word) : (at(word) >> shift) | (at(word + 1) << (kChunkSide - shift));
}

std::uint64_t lowest(int bits) { return (std::uint64_t{1} << bits) - 1; }

/// A wall is soon told from a post when one looks from the middle out.
bool stands_alone(const CellBitmap& occupied, CellIndex c, const PostSize& size) {
  const std::uint64_t around = lowest(2 * size.alone + 1);
  const std::uint64_t post = lowest(2 * size.thick + 1) << (size.alone - size.thick);
  for (int away = 0; away <= size.alone; ++away) {
    const std::uint64_t mask = away <= size.thick ? around & ~post : around;
    for (const int y : {c.y - away, c.y + away})
      if ((cells_from(occupied, {c.x - size.alone, y}) & mask) != 0) return false;
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
