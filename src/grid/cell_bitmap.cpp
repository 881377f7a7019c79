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

CellTile CellBitmap::tile(ChunkIndex chunk) const {
  CellTile tile;
  const int first_row = (chunk.y - box_.min.y) * kChunkSide;
  for (int r = 0; r < kChunkSide; ++r)
    tile[static_cast<std::size_t>(r)] = row(first_row + r)[chunk.x - box_.min.x];
  return tile;
}

void CellBitmap::put(ChunkIndex chunk, const CellTile& tile) {
  const int first_row = (chunk.y - box_.min.y) * kChunkSide;
  for (int r = 0; r < kChunkSide; ++r)
    row(first_row + r)[chunk.x - box_.min.x] = tile[static_cast<std::size_t>(r)];
}

}  // namespace dynslam
