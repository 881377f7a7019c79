// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "base/pose2.h"
#include "slam/finished_map.h"

namespace dynslam {

/// Finds the pose at which points lie best on the surfaces of a cloud, from a start a few centimetres off.
///
/// Each point is drawn to the line through the cloud's points around it, across that line only (iterated
/// closest point to line, Censi, ICRA 2008): a mean over a dozen cells lies far nearer the wall than any of
/// them, and a bare corridor says nothing at all of the way along it, which a sum of bytes cannot tell from
/// the pattern of the cells. Where the cloud has no direction (a thin pole, a corner), it does not pull.
class SurfaceFit {
 public:
  struct Result {
    Pose2 cloud_T_points;
    /// Inverse covariance of (x, y, yaw) in the cloud's frame: 1/m2, 1/(m rad), 1/rad2. Singular where the
    /// surfaces leave a direction open.
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    double residual_m = 0.0;  ///< root of the mean squared distance from the lines
    bool settled =
        false;  ///< false: it strayed too far or found nothing to hold on to; the pose is the start
  };

  /// Copies what it needs of the cloud.
  SurfaceFit(std::span<const CloudPoint> cloud, double cell_size_m);

  Result fit(std::span<const Vector2> points_m, const Pose2& start) const;

 private:
  struct Line {
    Vector2 through, normal;
  };
  struct Sums;

  std::optional<Line> line_near(const Vector2& at) const;
  int column(double x) const;
  int row(double y) const;
  Sums sum_up(std::span<const Vector2> points_m, const Pose2& pose) const;

  double cell_size_m_, reach_m_;
  Vector2 low_ = Vector2::Zero();
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> begins_;  ///< where in points_ each bin begins; bins of a reach by a reach
  std::vector<Eigen::Vector2f> points_;
};

}  // namespace dynslam
