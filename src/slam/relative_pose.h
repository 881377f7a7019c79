// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <Eigen/Cholesky>
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
inline RelativePose operator*(const RelativePose& a_T_b, const RelativePose& b_T_c) {
  const Pose2 a_T_c = a_T_b.pose * b_T_c.pose;
  Eigen::Matrix3d by_first = Eigen::Matrix3d::Identity();
  by_first(0, 2) = a_T_b.pose.y - a_T_c.y;  // a turn of b swings c around b
  by_first(1, 2) = a_T_c.x - a_T_b.pose.x;
  Eigen::Matrix3d by_second = Eigen::Matrix3d::Identity();
  const double c = std::cos(a_T_b.pose.yaw), s = std::sin(a_T_b.pose.yaw);
  by_second.topLeftCorner<2, 2>() << c, -s, s, c;
  return {a_T_c, by_first * a_T_b.covariance * by_first.transpose() +
                     by_second * b_T_c.covariance * by_second.transpose()};
}

/// b_T_a from a_T_b, to first order.
inline RelativePose inverse(const RelativePose& a_T_b) {
  const Pose2 b_T_a = a_T_b.pose.inverse();
  const double c = std::cos(a_T_b.pose.yaw), s = std::sin(a_T_b.pose.yaw);
  Eigen::Matrix3d jacobian;
  jacobian << -c, -s, b_T_a.y, s, -c, -b_T_a.x, 0, 0, -1;
  return {b_T_a, jacobian * a_T_b.covariance * jacobian.transpose()};
}

/// Squared Mahalanobis distance of a measurement from `expected`: chi-squared with 3 degrees of freedom where
/// the two are the same. REQUIRES: a positive definite covariance.
inline double mahalanobis2(const RelativePose& measured, const Pose2& expected) {
  const Eigen::Vector3d off(measured.pose.x - expected.x, measured.pose.y - expected.y,
                            turn(expected.yaw, measured.pose.yaw));
  return off.dot(measured.covariance.llt().solve(off));
}

/// A covariance of independent errors of (x, y, yaw).
inline Eigen::Matrix3d spread(double xy_m, double yaw_rad) {
  return Eigen::Vector3d(xy_m * xy_m, xy_m * xy_m, yaw_rad * yaw_rad).asDiagonal();
}

/// A covariance given along the axes of a pose's yaw, along those of the frame around it.
inline Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance, double yaw) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(yaw), -std::sin(yaw), std::sin(yaw), std::cos(yaw);
  return turn * covariance * turn.transpose();
}

}  // namespace dynslam
