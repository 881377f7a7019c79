// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grid/chunk.h"

namespace dynslam {

/// A set of cells inside a rectangle of chunks, one bit a cell. Bit b of a word is the cell b to the right of
/// the word's first; words fall together with chunk rows, so that a word is the set for one row of one chunk.
class CellBitmap {
 public:
  /// Covers `box`, all bits clear. Keeps its memory from one call to the next.
  void reset(const ChunkBox& box);

  const ChunkBox& box() const { return box_; }
  CellIndex first() const { return first_cell(box_.min); }
  int words_per_row() const { return words_per_row_; }
  int rows() const { return box_.height() * kChunkSide; }
  bool contains(CellIndex c) const;

  /// False outside the rectangle.
  bool test(CellIndex c) const { return contains(c) && ((word(c) >> (c.x & kChunkMask)) & 1U) != 0; }
  /// REQUIRES (these three): contains(c).
  void set(CellIndex c) { word(c) |= std::uint64_t{1} << (c.x & kChunkMask); }
  void clear(CellIndex c) { word(c) &= ~(std::uint64_t{1} << (c.x & kChunkMask)); }
  void toggle(CellIndex c) { word(c) ^= std::uint64_t{1} << (c.x & kChunkMask); }

  /// The words of a row, counted from the lowest.
  std::uint64_t* row(int r) {
    return &words_[static_cast<std::size_t>(r) * static_cast<std::size_t>(words_per_row_)];
  }
  const std::uint64_t* row(int r) const {
    return &words_[static_cast<std::size_t>(r) * static_cast<std::size_t>(words_per_row_)];
  }
  /// The cells of one chunk. REQUIRES (both): box() holds it.
  CellTile tile(ChunkIndex chunk) const;
  void put(ChunkIndex chunk, const CellTile& tile);

  std::size_t count() const;

 private:
  std::uint64_t& word(CellIndex c) { return row(c.y - first().y)[(c.x >> kChunkBits) - box_.min.x]; }
  std::uint64_t word(CellIndex c) const { return row(c.y - first().y)[(c.x >> kChunkBits) - box_.min.x]; }

  ChunkBox box_;
  int words_per_row_ = 0;
  std::vector<std::uint64_t> words_;
};

}  // namespace dynslam
