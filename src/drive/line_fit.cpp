// SPDX-License-Identifier: MIT
#include "drive/line_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace dynslam {

Line line_through(std::span<const Vector2> points) {
  Vector2 mean = Vector2::Zero();
  for (const Vector2& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Vector2& p : points) spread += (p - mean) * (p - mean).transpose();
  spread /= static_cast<double>(points.size());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(spread);
  return {mean, axes.eigenvectors().col(1), std::sqrt(std::max(0.0, axes.eigenvalues()(0))),
          std::sqrt(12.0 * std::max(0.0, axes.eigenvalues()(1)))};
}

std::optional<double> range_to(const Line& line, const Vector2& direction) {
  const Vector2 normal(-line.along.y(), line.along.x());
  const double towards = direction.dot(normal);
  if (std::abs(towards) < 1e-6) return std::nullopt;
  const double range_m = line.through.dot(normal) / towards;
  if (range_m <= 0.0) return std::nullopt;
  return range_m;
}

}  // namespace dynslam
