// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "grid/chunked_grid.h"

namespace dynslam {

/// Fills a grid from rows of text, the first row on top: '#' occupied, '.' free, ' ' unknown. The lower left
/// cell is `low`.
inline void draw(ChunkedGrid& grid, const std::vector<std::string>& rows, CellIndex low = {}) {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      const CellIndex cell{low.x + static_cast<int>(c), low.y + static_cast<int>(rows.size() - 1 - r)};
      for (int look = 0; look < 10; ++look) {
        if (rows[r][c] == '#') grid.add_hit(cell);
        if (rows[r][c] == '.') grid.add_miss(cell);
      }
    }
  }
}

/// The states of a rectangle as rows of text, in the same letters.
template <class Map>
std::vector<std::string> drawing_of(const Map& map, CellIndex low, int width, int height) {
  std::vector<std::string> rows;
  for (int y = height - 1; y >= 0; --y) {
    std::string row;
    for (int x = 0; x < width; ++x) {
      const CellState s = map.state({low.x + x, low.y + y});
      row += s == CellState::kOccupied ? '#' : s == CellState::kFree ? '.' : ' ';
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace dynslam
