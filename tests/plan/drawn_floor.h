// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "grid/chunked_grid.h"
#include "plan/costmap.h"
#include "plan/path_planner.h"

namespace dynslam {

inline constexpr double kCell_m = 0.02;
inline constexpr double kRadius_m = 0.19;

/// A floor to plan on. Distances in metres; a cell is 2 cm.
class DrawnFloor {
 public:
  void occupy(double x0, double y0, double x1, double y1) { fill(x0, y0, x1, y1, true); }
  void clear(double x0, double y0, double x1, double y1) { fill(x0, y0, x1, y1, false); }
  void set(CellIndex c, bool occupied) {
    for (int look = 0; look < 10; ++look) occupied ? grid.add_hit(c) : grid.add_miss(c);
  }
  Costmap costmap() {
    Costmap map(kCell_m);
    map.update(grid.snapshot());
    return map;
  }

  ChunkedGrid grid{kCell_m};

 private:
  void fill(double x0, double y0, double x1, double y1, bool occupied) {
    const CellIndex low = cell_at({x0 + 1e-6, y0 + 1e-6}, kCell_m),
                    high = cell_at({x1 - 1e-6, y1 - 1e-6}, kCell_m);
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) set({x, y}, occupied);
    }
  }
};

/// Rows of text, the first on top, a letter 10 x 10 cm: '#' occupied, '.' free, ' ' unknown. Its lower left
/// corner is at `low`.
inline DrawnFloor floor_of(const std::vector<std::string>& rows, Vector2 low = {0, 0}) {
  DrawnFloor floor;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      const double x = low.x() + 0.1 * double(c), y = low.y() + 0.1 * double(rows.size() - 1 - r);
      if (rows[r][c] == '#') floor.occupy(x, y, x + 0.1, y + 0.1);
      if (rows[r][c] == '.') floor.clear(x, y, x + 0.1, y + 0.1);
    }
  }
  return floor;
}

/// The least clearance along a route, looked at every 2 mm.
inline double least_clearance_m(const Costmap& map, const std::vector<Vector2>& route,
                                std::size_t first = 0) {
  double least = Costmap::kReach_m;
  for (std::size_t i = first; i + 1 < route.size(); ++i) {
    const int steps = 1 + static_cast<int>((route[i + 1] - route[i]).norm() / 0.002);
    for (int k = 0; k <= steps; ++k)
      least = std::min(least, map.clearance_m(route[i] + (route[i + 1] - route[i]) * k / steps));
  }
  return least;
}

}  // namespace dynslam
