// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "grid/chunk.h"

/// Sets of cells of three by three chunks, for what depends on a chunk and its surroundings.
namespace dynslam {

/// A row across three chunks side by side; bit b of a word is the cell b to the right of the word's first.
using WideRow = std::array<std::uint64_t, 3>;
using ChunkWindow = std::array<WideRow, 3 * kChunkSide>;

inline constexpr int kMostDepth = 32, kBeside = 24;  ///< cells

/// Leaves the cells that lie in some square of `side` cells all of which are in the set (the opening of the
/// set by that square). Holds for the middle chunk and for kBeside cells around it. REQUIRES: 1 <= side <=
/// kMostDepth.
void keep_deep(ChunkWindow& cells, int side);

/// Adds the cells of `within` beside those in the set, `steps` times over. Holds where both held, but for as
/// many cells along the edge.
void grow(ChunkWindow& cells, const ChunkWindow& within, int steps);

/// Adds the cells of `some` that are not in `but`.
void add_without(ChunkWindow& cells, const ChunkWindow& some, const ChunkWindow& but);

/// What of the middle chunk is in the set.
CellTile middle_of(const ChunkWindow& cells);
/// The cells of the middle chunk beside which (left, right, above, below) a cell is in the set.
CellTile beside(const ChunkWindow& cells);

}  // namespace dynslam
