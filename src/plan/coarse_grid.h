// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grid/chunk.h"

namespace dynslam {

inline constexpr int kCoarseBits = 2;
inline constexpr int kCoarseSide = 1 << kCoarseBits;             ///< cells
inline constexpr int kCoarseOfChunk = kChunkSide / kCoarseSide;  ///< coarse cells along a chunk

/// 4 x 4 cells as the search sees them: by their roomiest cell, so that a passage barely wide enough is not
/// lost to where it lies against the coarse grid.
struct CoarseCell {
  std::uint8_t clearance = 0;  ///< steps, of the roomiest cell
  std::uint8_t about = 0;      ///< the bits below
  std::uint8_t once = 0;       ///< the most clearance that it ever had while it was known

  static constexpr std::uint8_t kKnown = 16;   ///< at least half of the cells are
  static constexpr std::uint8_t kByPost = 32;  ///< beside a post that may have a wide foot
  static constexpr std::uint8_t kBest = 15;    ///< which cell is the roomiest: 4 y + x
  bool known() const { return (about & kKnown) != 0; }
  bool by_post() const { return (about & kByPost) != 0; }
};

/// The coarse cells of a rectangle of chunks as one flat array, with a rim two wide of cells that nobody can
/// pass: a search needs no look at the edges.
class CoarseGrid {
 public:
  static constexpr int kRim = 2;

  /// Covers `box`; what lies in both the old box and the new one is kept.
  void cover(const ChunkBox& box);

  const ChunkBox& box() const { return box_; }
  int stride() const { return stride_; }
  bool contains(CellIndex cell) const {
    const ChunkIndex c = chunk_of(cell);
    return c.x >= box_.min.x && c.x <= box_.max.x && c.y >= box_.min.y && c.y <= box_.max.y;
  }
  std::size_t size() const { return cells_.size(); }
  const CoarseCell& operator[](std::size_t index) const { return cells_[index]; }
  CoarseCell& operator[](std::size_t index) { return cells_[index]; }

  /// REQUIRES: the cell lies in the box.
  std::size_t index_of(CellIndex cell) const {
    const int x = (cell.x >> kCoarseBits) - first_.x, y = (cell.y >> kCoarseBits) - first_.y;
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(x);
  }
  /// The lower left one of its cells.
  CellIndex corner(std::size_t index) const {
    const auto stride = static_cast<std::size_t>(stride_);
    return {(static_cast<int>(index % stride) + first_.x) * kCoarseSide,
            (static_cast<int>(index / stride) + first_.y) * kCoarseSide};
  }
  CellIndex best_cell(std::size_t index) const {
    const int best = cells_[index].about & CoarseCell::kBest;
    const CellIndex c = corner(index);
    return {c.x + best % kCoarseSide, c.y + best / kCoarseSide};
  }

 private:
  ChunkBox box_;
  CellIndex first_;  ///< the coarse cell at index 0, in the rim
  int stride_ = 0;
  std::vector<CoarseCell> cells_;
};

}  // namespace dynslam
