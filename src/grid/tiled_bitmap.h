// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/cell_bitmap.h"

namespace dynslam {

/// A rectangle of cells, both ends inside; empty when max < min.
struct CellBox {
  CellIndex min{0, 0};
  CellIndex max{-1, -1};
  bool empty() const { return max.x < min.x || max.y < min.y; }
};

/// A set of cells for keeping: tiles that hold nothing, or everything, take no memory beyond a place in a
/// table. What rays of 30 m saw of a building takes a tenth of its rectangle. Copies share nothing.
class TiledBitmap {
 public:
  TiledBitmap() = default;
  explicit TiledBitmap(const CellBitmap& cells);

  bool test(CellIndex c) const { return ((tile(chunk_of(c))[row_of(c)] >> (c.x & kChunkMask)) & 1U) != 0; }
  /// 64 cells of a row from `first` on, which need not be the first of a chunk: bit b is the cell b to the
  /// right of it.
  std::uint64_t word(CellIndex first) const;
  /// The same for as many rows upwards as there are words; much faster than one at a time.
  void words(CellIndex first, std::span<std::uint64_t> rows) const;
  /// All clear outside of box().
  const CellTile& tile(ChunkIndex chunk) const;

  /// The chunks that hold anything lie in here.
  const ChunkBox& box() const { return box_; }
  /// The least rectangle that holds all cells.
  CellBox bounds() const;
  bool empty() const { return box_.empty(); }
  std::size_t count() const;
  std::size_t bytes() const { return tiles_.size() * sizeof(CellTile) + places_.size() * sizeof(Place); }

 private:
  using Place = std::uint32_t;
  static constexpr Place kNone = 0, kAll = 1, kFirst = 2;  ///< kFirst + i: tiles_[i]
  static constexpr std::size_t row_of(CellIndex c) { return static_cast<std::size_t>(c.y & kChunkMask); }
  void add(const CellTile& tile);

  ChunkBox box_;
  std::vector<Place> places_;  ///< of the chunks of the box, row by row
  std::vector<CellTile> tiles_;
};

}  // namespace dynslam
