// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grid/cell_bitmap.h"

namespace dynslam {

/// Clearance in a byte: steps of 4 mm, rounded down.
inline constexpr double kClearanceStep_m = 0.004;

/// The clearance of each cell of a chunk, rows contiguous.
using ClearanceTile = std::array<std::array<std::uint8_t, kChunkSide>, kChunkSide>;

/// The exact Euclidean distance transform of one chunk, cut at a reach: only what lies within the reach is
/// looked at. First how far the nearest blocked cell of each column is, then row by row the least of
/// dx^2 + column^2 (Saito and Toriwaki, 1994), 16 cells at once and from near to far, so that it ends early.
class ChunkClearance {
 public:
  ChunkClearance(double cell_size_m, double reach_m);

  int reach_cells() const { return reach_; }
  /// The clearance where nothing is within reach.
  std::uint8_t most() const { return steps_.back(); }
  /// From cell centre to cell centre. False, and `out` as it was, when nothing is within reach of the chunk.
  /// The two sets cover the same box; nothing is blocked outside of it.
  bool compute(const CellBitmap& occupied, const CellBitmap& forbidden, ChunkIndex chunk, ClearanceTile& out);

 private:
  bool gather(const CellBitmap& occupied, const CellBitmap& forbidden, ChunkIndex chunk);
  void step_column_distances(int window_row);
  void measure_columns();
  void measure_row(int row, std::array<std::uint8_t, kChunkSide>& out);

  int reach_;                              ///< cells
  int side_chunks_;                        ///< chunks to the left and right that the reach touches
  int width_;                              ///< cells of a row of the window
  std::vector<std::uint8_t> steps_;        ///< by squared distance in cells
  std::vector<std::uint16_t> squares_;     ///< by distance along a column
  std::vector<std::uint64_t> blocked_;     ///< the chunk with a border, row by row
  std::vector<std::uint8_t> distance_;     ///< of the row where the column pass is
  std::vector<std::uint8_t> columns_;      ///< distance along the column, for the chunk's rows
  std::vector<std::uint16_t> row_square_;  ///< of one row
};

}  // namespace dynslam
