// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "autopilot/frontier_map.h"
#include "grid/drawn_map.h"

namespace dynslam {

/// Drawings have a letter for a square of 10 cm, as grids of 10 cm cells or of smaller ones.
inline constexpr double kLetter_m = 0.1;

/// Each letter as `times` by `times` letters.
inline std::vector<std::string> enlarged(const std::vector<std::string>& rows, int times) {
  std::vector<std::string> large;
  for (const std::string& row : rows) {
    std::string wide;
    for (const char letter : row) wide.append(static_cast<std::size_t>(times), letter);
    large.insert(large.end(), static_cast<std::size_t>(times), wide);
  }
  return large;
}

inline GridSnapshot map_of(const std::vector<std::string>& rows, double cell_size_m = kLetter_m) {
  ChunkedGrid grid(cell_size_m);
  draw(grid, enlarged(rows, static_cast<int>(kLetter_m / cell_size_m + 0.5)));
  return grid.snapshot();
}

/// Without what is only the rest of one.
inline std::vector<Frontier> frontiers_of(const std::vector<std::string>& rows,
                                          double cell_size_m = kLetter_m) {
  FrontierMap frontiers;
  frontiers.update({}, map_of(rows, cell_size_m));
  std::vector<Frontier> found = frontiers.frontiers();
  std::erase_if(found, [](const Frontier& f) { return f.is_rest; });
  return found;
}

}  // namespace dynslam
