// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <utility>

#include <Eigen/Core>
#include <ceres/sized_cost_function.h>

#include "base/pose2.h"

namespace dynslam {

/// How far two poses (blocks x, y, yaw in the map frame) are from the relative pose that was measured between
/// them, in standard deviations:
///
///     W * ( R(yaw_a)^T (t_b - t_a) - t_ab ; wrap(yaw_b - yaw_a - yaw_ab) ),   W^T W = covariance^-1
class RelativePoseCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  RelativePoseCost(const Pose2& a_T_b, Eigen::Matrix3d whitening)
      : a_T_b_(a_T_b), whitening_(std::move(whitening)) {}

  bool Evaluate(const double* const* poses, double* residuals, double** jacobians) const override {
    const double *a = poses[0], *b = poses[1];
    const double c = std::cos(a[2]), s = std::sin(a[2]);
    const Pose2 seen{c * (b[0] - a[0]) + s * (b[1] - a[1]), c * (b[1] - a[1]) - s * (b[0] - a[0]),
                     b[2] - a[2]};
    Eigen::Map<Eigen::Vector3d>{residuals} =
        whitening_ * Eigen::Vector3d(seen.x - a_T_b_.x, seen.y - a_T_b_.y, turn(a_T_b_.yaw, seen.yaw));
    if (jacobians == nullptr) return true;
    Eigen::Matrix3d by_a, by_b;
    by_a << -c, -s, seen.y, s, -c, -seen.x, 0, 0, -1;
    by_b << c, s, 0, -s, c, 0, 0, 0, 1;
    using RowMajor = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
    if (jacobians[0] != nullptr) RowMajor{jacobians[0]} = whitening_ * by_a;
    if (jacobians[1] != nullptr) RowMajor{jacobians[1]} = whitening_ * by_b;
    return true;
  }

 private:
  Pose2 a_T_b_;
  Eigen::Matrix3d whitening_;
};

/// The same for the turn between two poses alone.
class TurnCost final : public ceres::SizedCostFunction<1, 3, 3> {
 public:
  TurnCost(double yaw_a_to_b_rad, double whitening) : turn_rad_(yaw_a_to_b_rad), whitening_(whitening) {}

  bool Evaluate(const double* const* poses, double* residuals, double** jacobians) const override {
    residuals[0] = whitening_ * turn(turn_rad_, poses[1][2] - poses[0][2]);
    if (jacobians == nullptr) return true;
    using Row = Eigen::Map<Eigen::RowVector3d>;
    if (jacobians[0] != nullptr) Row{jacobians[0]} << 0, 0, -whitening_;
    if (jacobians[1] != nullptr) Row{jacobians[1]} << 0, 0, whitening_;
    return true;
  }

 private:
  double turn_rad_;
  double whitening_;
};

}  // namespace dynslam
