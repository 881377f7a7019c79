// SPDX-License-Identifier: MIT
#include "autopilot/deep_cells.h"

#include <algorithm>
#include <cstddef>

namespace dynslam {
namespace {

/// The row moved by 0 < n < 64 cells; what comes in is clear.
WideRow moved_left(const WideRow& row, int n) {
  return {row[0] >> n | row[1] << (64 - n), row[1] >> n | row[2] << (64 - n), row[2] >> n};
}
WideRow moved_right(const WideRow& row, int n) {
  return {row[0] << n, row[1] << n | row[0] >> (64 - n), row[2] << n | row[1] >> (64 - n)};
}

void keep_common(WideRow& row, const WideRow& other) {
  for (std::size_t w = 0; w < row.size(); ++w) row[w] &= other[w];
}
void add(WideRow& row, const WideRow& other) {
  for (std::size_t w = 0; w < row.size(); ++w) row[w] |= other[w];
}

/// Calls `step(n)` with steps that reach over `side` cells together, each no longer than what is reached
/// before.
template <class Step>
void in_doubling_steps(int side, Step&& step) {
  for (int reached = 1; reached < side;) {
    const int n = std::min(reached, side - reached);
    step(n);
    reached += n;
  }
}

}  // namespace

/// First each cell stands for the square of which it is the lower left corner, then the squares are drawn.
void keep_deep(ChunkWindow& cells, int side) {
  const int low = kChunkSide - side - kBeside, high = 2 * kChunkSide + side + kBeside;
  const auto row = [&](int r) -> WideRow& { return cells[static_cast<std::size_t>(r)]; };
  in_doubling_steps(side, [&](int n) {
    for (int r = low; r < high; ++r) keep_common(row(r), moved_left(row(r), n));
    for (int r = low; r < high; ++r) keep_common(row(r), r + n < high ? row(r + n) : WideRow{});
  });
  in_doubling_steps(side, [&](int n) {
    for (int r = low; r < high; ++r) add(row(r), moved_right(row(r), n));
    for (int r = high - 1; r >= low + n; --r) add(row(r), row(r - n));
  });
}

void grow(ChunkWindow& cells, const ChunkWindow& within, int steps) {
  for (int step = 0; step < steps; ++step) {
    const ChunkWindow before = cells;
    for (std::size_t r = 1; r + 1 < cells.size(); ++r) {
      WideRow& row = cells[r];
      add(row, moved_left(before[r], 1));
      add(row, moved_right(before[r], 1));
      add(row, before[r - 1]);
      add(row, before[r + 1]);
      keep_common(row, within[r]);
    }
  }
}

void add_without(ChunkWindow& cells, const ChunkWindow& some, const ChunkWindow& but) {
  for (std::size_t r = 0; r < cells.size(); ++r)
    for (std::size_t w = 0; w < cells[r].size(); ++w) cells[r][w] |= some[r][w] & ~but[r][w];
}

CellTile middle_of(const ChunkWindow& cells) {
  CellTile found;
  for (std::size_t r = 0; r < kChunkSide; ++r) found[r] = cells[kChunkSide + r][1];
  return found;
}

CellTile beside(const ChunkWindow& cells) {
  CellTile found;
  for (std::size_t r = 0; r < kChunkSide; ++r) {
    const WideRow& row = cells[kChunkSide + r];
    found[r] = cells[kChunkSide + r - 1][1] | cells[kChunkSide + r + 1][1] | moved_left(row, 1)[1] |
               moved_right(row, 1)[1];
  }
  return found;
}

}  // namespace dynslam
