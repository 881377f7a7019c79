// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>

#include "base/pose2.h"
#include "slam/hit_window.h"

namespace dynslam {

/// One Gauss-Newton step's worth of how a scan lies on a map, in cells and radians.
struct HitFit {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< sum of weight * J^T J
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();     ///< sum of weight * (1 - hit) * J^T
};

/// The hit plane seen through a uniform cubic B-spline at a position in cells (the centre of cell 0 is 0.5): 0 to 1,
/// twice differentiable. 0 where the window does not reach.
float smooth_hit(const HitWindow& window, float x, float y);

/// Value and slope at every point, moved by window_T_robot (cells), summed up. Points outside the window are left out.
HitFit fit_to_hits(const HitWindow& window, std::span<const MatchPoint> points, const Pose2& window_T_robot);

}  // namespace dynslam
