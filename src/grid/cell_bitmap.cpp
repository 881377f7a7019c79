// SPDX-License-Identifier: MIT
#include "grid/cell_bitmap.h"

#include <bit>

namespace dynslam {

void CellBitmap::reset(const ChunkBox& box) {
  box_ = box;
  words_per_row_ = box.width();
  words_.assign(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()) * kChunkSide,
                0);
}

bool CellBitmap::contains(CellIndex c) const {
  const ChunkIndex k = chunk_of(c);
  return k.x >= box_.min.x && k.x <= box_.max.x && k.y >= box_.min.y && k.y <= box_.max.y;
}

std::size_t CellBitmap::count() const {
  std::size_t n = 0;
  for (const std::uint64_t w : words_) n += static_cast<std::size_t>(std::popcount(w));
  return n;
}

CellBitmap CellBitmap::grown(int times) const {
  CellBitmap result = *this;
  for (int t = 0; t < times; ++t) {
    const CellBitmap before = result;
    for (int r = 0; r < rows(); ++r) {
      std::uint64_t* row_out = result.row(r);
      for (int w = 0; w < words_per_row_; ++w) {
        const std::uint64_t here = before.row(r)[w];
        const std::uint64_t left = w > 0 ? before.row(r)[w - 1] >> 63 : 0;
        const std::uint64_t right = w + 1 < words_per_row_ ? before.row(r)[w + 1] << 63 : 0;
        const std::uint64_t below = r > 0 ? before.row(r - 1)[w] : 0;
        const std::uint64_t above = r + 1 < rows() ? before.row(r + 1)[w] : 0;
        row_out[w] |= here << 1 | left | here >> 1 | right | below | above;
      }
    }
  }
  return result;
}

}  // namespace dynslam
