// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "base/pose2.h"

namespace dynslam {

/// A straight line through points.
struct Line {
  Vector2 through, along;  ///< the mean; of length 1
  double across_m = 0.0;   ///< the points' distance from it, root mean square
  double length_m = 0.0;   ///< as of points spread evenly along it
};

/// By least squares of the distances. REQUIRES: points.
Line line_through(std::span<const Vector2> points);

/// How far from (0, 0) one who looks in a direction meets the line; nothing when it is behind, or beside.
std::optional<double> range_to(const Line& line, const Vector2& direction);

}  // namespace dynslam
