// SPDX-License-Identifier: MIT
#include "slam/surface_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace dynslam {
namespace {

constexpr double kLeastReach_m = 0.1;
constexpr double kReachCells = 4.0;
constexpr int kLeastNeighbours = 4;
/// Variance across a line over that along it: more is no line.
constexpr double kMostBreadth = 0.3;
constexpr int kMostIterations = 8;
constexpr double kSettled = 0.02;  ///< cells that the last step may be long
/// Points next to each other err together: each counts as this much of an independent one.
constexpr double kEvidence = 0.3;
/// How strongly a direction that the surfaces leave open is held where it was: as by so many points.
constexpr double kHold = 0.5;

bool is_finite(const CloudPoint& p) { return std::isfinite(p.x_m) && std::isfinite(p.y_m); }

/// 1 at 0, falling smoothly to 0 at 1.
double fade(double share2) { return share2 < 1 ? (1 - share2) * (1 - share2) : 0.0; }

}  // namespace

struct SurfaceFit::Sums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< per squared unit of residual
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  double squares = 0.0, weight = 0.0;
};

SurfaceFit::SurfaceFit(std::span<const CloudPoint> cloud, double cell_size_m)
    : cell_size_m_(cell_size_m), reach_m_(std::max(kLeastReach_m, kReachCells * cell_size_m)) {
  std::vector<Eigen::Vector2f> finite;
  finite.reserve(cloud.size());
  for (const CloudPoint& p : cloud) {
    if (is_finite(p)) finite.emplace_back(p.x_m, p.y_m);
  }
  if (finite.empty()) return;
  Eigen::Vector2f low = finite.front(), high = low;
  for (const Eigen::Vector2f& p : finite) low = low.cwiseMin(p), high = high.cwiseMax(p);
  low_ = low.cast<double>();
  columns_ = column(high.x()) + 1;
  rows_ = row(high.y()) + 1;
  begins_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  const auto bin = [&](const Eigen::Vector2f& p) {
    return static_cast<std::size_t>(row(p.y())) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column(p.x()));
  };
  for (const Eigen::Vector2f& p : finite) ++begins_[bin(p) + 1];
  for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
  std::vector<std::uint32_t> next = begins_;
  points_.resize(finite.size());
  for (const Eigen::Vector2f& p : finite) points_[next[bin(p)]++] = p;
}

int SurfaceFit::column(double x) const { return floor_to_int((x - low_.x()) / reach_m_); }
int SurfaceFit::row(double y) const { return floor_to_int((y - low_.y()) / reach_m_); }

/// The line through the cloud around a place: mean and main direction of the points in reach, near ones
/// counting more.
std::optional<SurfaceFit::Line> SurfaceFit::line_near(const Vector2& at) const {
  const double reach2 = reach_m_ * reach_m_;
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  int neighbours = 0;
  const int c0 = std::max(0, column(at.x()) - 1), c1 = std::min(columns_ - 1, column(at.x()) + 1);
  const int r0 = std::max(0, row(at.y()) - 1), r1 = std::min(rows_ - 1, row(at.y()) + 1);
  for (int r = r0; r <= r1 && c0 <= c1; ++r) {
    const std::size_t first = static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_);
    const std::uint32_t end = begins_[first + static_cast<std::size_t>(c1) + 1];
    for (std::uint32_t i = begins_[first + static_cast<std::size_t>(c0)]; i < end; ++i) {
      const double x = points_[i].x() - at.x(), y = points_[i].y() - at.y();
      const double w = fade((x * x + y * y) / reach2);
      if (w <= 0) continue;
      ++neighbours;
      n += w, sx += w * x, sy += w * y, sxx += w * x * x, sxy += w * x * y, syy += w * y * y;
    }
  }
  if (neighbours < kLeastNeighbours) return std::nullopt;
  const double mx = sx / n, my = sy / n;
  const double a = sxx / n - mx * mx, b = sxy / n - mx * my, c = syy / n - my * my;
  const double mean = 0.5 * (a + c), spread = Vector2(0.5 * (a - c), b).norm();
  if (mean - spread > kMostBreadth * (mean + spread)) return std::nullopt;
  const double along = 0.5 * std::atan2(2 * b, a - c);
  return Line{{at.x() + mx, at.y() + my}, {-std::sin(along), std::cos(along)}};
}

SurfaceFit::Sums SurfaceFit::sum_up(std::span<const Vector2> points_m, const Pose2& pose) const {
  Sums sums;
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  for (const Vector2& q : points_m) {
    const Vector2 arm(c * q.x() - s * q.y(), s * q.x() + c * q.y());
    const Vector2 at = arm + pose.translation();
    const std::optional<Line> line = line_near(at);
    if (!line) continue;
    const double off = line->normal.dot(line->through - at);
    const double w = fade(off * off / (reach_m_ * reach_m_));
    const Eigen::Vector3d moves(line->normal.x(), line->normal.y(),
                                line->normal.y() * arm.x() - line->normal.x() * arm.y());
    sums.information += w * moves * moves.transpose();
    sums.pull += w * off * moves;
    sums.squares += w * off * off;
    sums.weight += w;
  }
  return sums;
}

SurfaceFit::Result SurfaceFit::fit(std::span<const Vector2> points_m, const Pose2& start) const {
  double arms2 = 0;
  for (const Vector2& q : points_m) arms2 += q.squaredNorm();
  const double arm2 = points_m.empty() ? 1.0 : std::max(0.01, arms2 / static_cast<double>(points_m.size()));
  const Eigen::Matrix3d hold = kHold * Eigen::Vector3d(1, 1, arm2).asDiagonal().toDenseMatrix();
  Result result{start, Eigen::Matrix3d::Zero(), 0.0, false};
  if (points_.empty() || !is_finite(start)) return result;
  Pose2 pose = start;
  Sums sums;
  for (int i = 0; i < kMostIterations; ++i) {
    sums = sum_up(points_m, pose);
    const Eigen::Vector3d off(start.x - pose.x, start.y - pose.y, turn(pose.yaw, start.yaw));
    const Eigen::Vector3d step = (sums.information + hold).ldlt().solve(sums.pull + hold * off);
    pose = {pose.x + step.x(), pose.y + step.y(), wrap_angle(pose.yaw + step.z())};
    const bool strayed = !is_finite(pose) || (pose.translation() - start.translation()).norm() > 2 * reach_m_;
    if (strayed || sums.weight <= 0) return result;
    const double moved = std::max(step.head<2>().norm(), std::abs(step.z()) * std::sqrt(arm2));
    if (moved < kSettled * cell_size_m_) break;
  }
  const double variance = sums.squares / sums.weight;
  const double least = 0.25 * cell_size_m_ * cell_size_m_;
  return {pose, kEvidence / std::max(variance, least) * sums.information, std::sqrt(variance), true};
}

}  // namespace dynslam
