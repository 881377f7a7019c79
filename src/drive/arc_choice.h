// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "base/pose2.h"

namespace dynslam {

/// How one would like to drive: along an arc to a point.
struct ArcWish {
  double curvature_1pm = 0.0;       ///< to the left
  double last_curvature_1pm = 0.0;  ///< as driven until now
  double most_curvature_1pm = 0.0;
  double speed_mps = 0.0;
  Vector2 to_robot = Vector2::Zero();  ///< the point, from the robot
};

struct Arc {
  double curvature_1pm = 0.0;
  double speed_mps = 0.0;  ///< more than 0
};

/// Speed at which an arc may be driven, at most; 0: not at all.
using AllowedSpeed = std::function<double(double curvature_1pm)>;

/// The wanted arc when it may be driven as fast as wanted; otherwise the best one of thirteen about it, by
/// how much nearer it leads to the point, how free it is, and how little it departs from what is driven: the
/// balance that the thesis struck among six segments of the scan. Nothing when none that leads nearer is
/// free.
std::optional<Arc> choose_arc(const ArcWish& wish, const AllowedSpeed& allowed_mps);

}  // namespace dynslam
