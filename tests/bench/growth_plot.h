// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace dynslam::bench {

/// What one kind of work costs, by the number of local maps there are.
struct GrowthSeries {
  struct Point {
    double maps = 0.0;  ///< more than 0
    double ms = 0.0;    ///< more than 0
  };
  std::string name;
  std::vector<Point> points;  ///< by rising number of maps
};

/// The exponent of the power of the number of maps that fits best: 1 is linear. NaN of fewer than two points.
double growth_exponent(const GrowthSeries& series);

/// Both axes logarithmic, with a dashed line that grows linearly to compare with: an SVG text. The frame is
/// as wide as the points of all series need; a series of a single point does not depend on the number of maps
/// and is drawn from side to side.
std::string growth_svg(const std::vector<GrowthSeries>& all);

}  // namespace dynslam::bench
