// SPDX-License-Identifier: MIT
#include "slam/relative_pose.h"

#include <cmath>

#include <Eigen/Cholesky>

namespace dynslam {

RelativePose operator*(const RelativePose& a_T_b, const RelativePose& b_T_c) {
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

RelativePose inverse(const RelativePose& a_T_b) {
  const Pose2 b_T_a = a_T_b.pose.inverse();
  const double c = std::cos(a_T_b.pose.yaw), s = std::sin(a_T_b.pose.yaw);
  Eigen::Matrix3d jacobian;
  jacobian << -c, -s, b_T_a.y, s, -c, -b_T_a.x, 0, 0, -1;
  return {b_T_a, jacobian * a_T_b.covariance * jacobian.transpose()};
}

double mahalanobis2(const RelativePose& measured, const Pose2& expected) {
  const Eigen::Vector3d off(measured.pose.x - expected.x, measured.pose.y - expected.y,
                            turn(expected.yaw, measured.pose.yaw));
  return off.dot(measured.covariance.llt().solve(off));
}

Eigen::Matrix3d spread(double xy_m, double yaw_rad) {
  return Eigen::Vector3d(xy_m * xy_m, xy_m * xy_m, yaw_rad * yaw_rad).asDiagonal();
}

Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance, double yaw) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(yaw), -std::sin(yaw), std::sin(yaw), std::cos(yaw);
  return turn * covariance * turn.transpose();
}

}  // namespace dynslam
