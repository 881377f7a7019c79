// SPDX-License-Identifier: MIT
#include "grid/trinary_map.h"

#include <algorithm>
#include <limits>

namespace dynslam {
namespace {

template <class Visit>
void for_each_known_cell(const GridSnapshot& map, Visit&& visit) {
  for (std::int32_t cy = map.box().min.y; cy <= map.box().max.y; ++cy) {
    for (std::int32_t cx = map.box().min.x; cx <= map.box().max.x; ++cx) {
      const Chunk* chunk = map.find({cx, cy});
      if (!chunk) continue;
      const CellIndex first = first_cell({cx, cy});
      for (int y = 0; y < kChunkSide; ++y) {
        for (int x = 0; x < kChunkSide; ++x) {
          const CellState state = cell_state(chunk->hit[y][x], chunk->miss[y][x]);
          if (state != CellState::kUnknown) visit(CellIndex{first.x + x, first.y + y}, state);
        }
      }
    }
  }
}

}  // namespace

TrinaryMap trinary_map(const GridSnapshot& map) {
  constexpr auto kMax = std::numeric_limits<std::int32_t>::max();
  CellIndex low{kMax, kMax}, high{-kMax, -kMax};
  for_each_known_cell(map, [&](CellIndex c, CellState) {
    low = {std::min(low.x, c.x), std::min(low.y, c.y)};
    high = {std::max(high.x, c.x), std::max(high.y, c.y)};
  });
  TrinaryMap out;
  out.cell_size_m = map.cell_size_m();
  if (low.x > high.x) return out;
  out.origin = low;
  out.width = high.x - low.x + 1;
  out.height = high.y - low.y + 1;
  out.cells.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height),
                   CellState::kUnknown);
  for_each_known_cell(map, [&](CellIndex c, CellState state) {
    out.cells[static_cast<std::size_t>(c.y - low.y) * static_cast<std::size_t>(out.width) +
              static_cast<std::size_t>(c.x - low.x)] = state;
  });
  return out;
}

TrinaryMap coarser(const TrinaryMap& map) {
  const auto half = [](std::int32_t n) { return (n - (n & 1)) / 2; };  // rounds down
  TrinaryMap out;
  out.cell_size_m = 2.0 * map.cell_size_m;
  out.origin = {half(map.origin.x), half(map.origin.y)};
  if (map.cells.empty()) return out;
  out.width = half(map.origin.x + map.width - 1) - out.origin.x + 1;
  out.height = half(map.origin.y + map.height - 1) - out.origin.y + 1;
  out.cells.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height),
                   CellState::kUnknown);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const auto x = static_cast<std::size_t>(half(map.origin.x + column) - out.origin.x);
      const auto y = static_cast<std::size_t>(half(map.origin.y + row) - out.origin.y);
      CellState& cell = out.cells[y * static_cast<std::size_t>(out.width) + x];
      cell = std::max(cell, map.at(column, row));  // in the order unknown, free, occupied
    }
  }
  return out;
}

}  // namespace dynslam
