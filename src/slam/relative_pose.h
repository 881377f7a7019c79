// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "base/pose2.h"

namespace dynslam {

/// The pose of one frame in another as it was measured. The covariance is that of the three numbers of
/// `pose`, so its x and y lie along the axes of the first frame: m2, m rad, rad2.
struct RelativePose {
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// a_T_c from a_T_b and b_T_c that were measured independently of each other, to first order.
RelativePose operator*(const RelativePose& a_T_b, const RelativePose& b_T_c);

/// b_T_a from a_T_b, to first order.
RelativePose inverse(const RelativePose& a_T_b);

/// Squared Mahalanobis distance of a measurement from `expected`: chi-squared with 3 degrees of freedom where
/// the two are the same. REQUIRES: a positive definite covariance.
double mahalanobis2(const RelativePose& measured, const Pose2& expected);

/// A covariance of independent errors of (x, y, yaw).
Eigen::Matrix3d spread(double xy_m, double yaw_rad);

/// A covariance given along the axes of a pose's yaw, along those of the frame around it.
Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance, double yaw);

}  // namespace dynslam
