// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "grid/cell_index.h"
#include "grid/chunked_grid.h"

namespace dynslam {

/// A finished map as one rectangle of states, for files and pictures. Row 0 is the lowest y (y is flipped
/// only at a picture's edge); cell (x, y) of the map is at cells[(y - origin.y) * width + (x - origin.x)].
struct TrinaryMap {
  double cell_size_m = 0.02;
  CellIndex origin;  ///< lower left cell
  int width = 0;
  int height = 0;
  std::vector<CellState> cells;

  CellState at(int column, int row) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(column)];
  }
};

/// The smallest rectangle of a map that holds all its known cells; 0 x 0 when there are none.
TrinaryMap trinary_map(const GridSnapshot& map);

/// The same map with cells of twice the size: occupied where any of the four was, else free where any was.
TrinaryMap coarser(const TrinaryMap& map);

}  // namespace dynslam
