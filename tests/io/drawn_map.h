// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "grid/trinary_map.h"

namespace dynslam {

/// A map as it is seen: the first line is the highest y; '#' occupied, '.' free, anything else unknown.
inline TrinaryMap drawn_map(const std::vector<std::string>& lines, CellIndex origin = {},
                            double cell_size_m = 0.02) {
  TrinaryMap map;
  map.cell_size_m = cell_size_m;
  map.origin = origin;
  map.height = static_cast<int>(lines.size());
  map.width = lines.empty() ? 0 : static_cast<int>(lines.front().size());
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    for (const char c : *line) {
      map.cells.push_back(c == '#'   ? CellState::kOccupied
                          : c == '.' ? CellState::kFree
                                     : CellState::kUnknown);
    }
  }
  return map;
}

}  // namespace dynslam
