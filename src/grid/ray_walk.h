// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "grid/cell_index.h"

namespace dynslam {

/// Calls `visit(CellIndex)` for each cell that the segment touches, in order, both ends' cells included
/// (Amanatides and Woo, 1987). The reference for FreeSpace, and the way to trace a single ray.
template <class Visit>
void walk_ray(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m, double cell_size_m, Visit&& visit) {
  const Eigen::Vector2d from = from_m / cell_size_m;
  const Eigen::Vector2d step_to = to_m / cell_size_m - from;
  CellIndex cell = cell_at(from_m, cell_size_m);
  const CellIndex last = cell_at(to_m, cell_size_m);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  // The share of the segment at which it enters the next column and the next row.
  const auto first_crossing = [](double start, double delta, std::int32_t index) {
    if (delta > 0) return (index + 1 - start) / delta;
    return delta < 0 ? (index - start) / delta : kNever;
  };
  const double column_share = step_to.x() == 0 ? kNever : 1 / std::abs(step_to.x());
  const double row_share = step_to.y() == 0 ? kNever : 1 / std::abs(step_to.y());
  double next_column = first_crossing(from.x(), step_to.x(), cell.x);
  double next_row = first_crossing(from.y(), step_to.y(), cell.y);
  // Counted in cells, not compared with the end's share, so that rounding can neither stop short nor run on.
  int columns = std::abs(last.x - cell.x);
  int rows = std::abs(last.y - cell.y);
  visit(cell);
  while (columns + rows > 0) {
    if (rows == 0 || (columns > 0 && next_column < next_row)) {
      cell.x += step_to.x() > 0 ? 1 : -1;
      next_column += column_share;
      --columns;
    } else {
      cell.y += step_to.y() > 0 ? 1 : -1;
      next_row += row_share;
      --rows;
    }
    visit(cell);
  }
}

}  // namespace dynslam
