// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Core>

#include "base/pose2.h"
#include "slam/hit_window.h"

namespace dynslam {

/// How a scan lies on a map, and which way it wants to go; cells and radians.
struct HitFit {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< curvature of the fit, positive semidefinite
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();     ///< of the sum of weight * hit
  double score = 0.0;                                     ///< the sum of weight * hit
};

/// The hit plane seen through a uniform cubic B-spline at a position in cells (the centre of cell 0 is 0.5):
/// 0 to 1, twice differentiable. 0 where the window does not reach.
float smooth_hit(const HitWindow& window, float x, float y);

/// Value, slope and curvature at every point, moved by window_T_robot (cells), summed up. Points outside the
/// window are left out. The curvature of a point is that of the logarithm times the value: -f'' + f' f'^T /
/// f, which for a ridge of Gaussian profile is f / sigma^2 across it at any distance, where -f'' alone turns
/// negative on the slopes and sends Newton's step the wrong way.
HitFit fit_to_hits(const HitWindow& window, std::span<const MatchPoint> points, const Pose2& window_T_robot);

}  // namespace dynslam
