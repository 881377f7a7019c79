// SPDX-License-Identifier: MIT
#include "drive/hidden_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>

#include <Eigen/Eigenvalues>

namespace dynslam {
namespace {

/// So near to the blind zone only those beams come back that noise makes longer: what they say is too far
/// away.
constexpr double kDubious_m = 0.015;
/// A wall that goes on hidden is seen last nearer than this beyond that.
constexpr double kBeyond_m = 0.03;
/// Of the seen part so much tells of its direction.
constexpr double kPiece_m = 0.15;
/// A piece of so many points, which lie so near to a line, and are drawn out to so much of it.
constexpr std::size_t kLeastPoints = 6;
constexpr double kStraight_m = 0.012, kLeastLength_m = 0.03;
/// Steps from sector to sector.
constexpr std::size_t kLeft = 1, kRight = Sight::kSectors - 1;
/// Where one sees so far behind the wall, it has come to its end.
constexpr double kBehind_m = 0.05;
/// The body is no larger than it is said to be, but may be smaller by about so much: what seems to be this
/// deep in it may be beside it.
constexpr double kInside_m = 0.02;

struct Line {
  Vector2 through, along;
};

/// By least squares of the distances; nothing when it is too short or crooked.
std::optional<Line> line_of(const std::vector<Vector2>& points) {
  if (points.size() < kLeastPoints) return std::nullopt;
  Vector2 mean = Vector2::Zero();
  for (const Vector2& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Vector2& p : points) spread += (p - mean) * (p - mean).transpose();
  spread /= static_cast<double>(points.size());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(spread);
  const double across_m = std::sqrt(std::max(0.0, axes.eigenvalues()(0)));
  const double length_m = std::sqrt(12.0 * std::max(0.0, axes.eigenvalues()(1)));
  if (across_m > kStraight_m || length_m < kLeastLength_m) return std::nullopt;
  return Line{mean, axes.eigenvectors().col(1)};
}

/// Where one looking in a direction meets the line; nothing when it is behind, or beside.
std::optional<double> range_to(const Line& line, const Vector2& direction) {
  const Vector2 normal(-line.along.y(), line.along.x());
  const double towards = direction.dot(normal);
  if (std::abs(towards) < 1e-6) return std::nullopt;
  const double range_m = line.through.dot(normal) / towards;
  if (range_m <= 0.0) return std::nullopt;
  return range_m;
}

std::optional<Line> wall_at(const Vector2& end, const std::vector<Vector2>& near) {
  std::vector<Vector2> piece;
  std::copy_if(near.begin(), near.end(), std::back_inserter(piece),
               [&end](const Vector2& p) { return (p - end).norm() < kPiece_m; });
  return line_of(piece);
}

bool is_deep_inside(const BodyConfig& body, const Vector2& p) {
  return std::abs(p.x()) < body.half_length_m() - kInside_m &&
         std::abs(p.y()) < body.half_width_m() - kInside_m;
}

}  // namespace

void continue_walls(std::vector<ObstaclePoint>& points, const Sight& sight, const Pose2& robot_T_lidar,
                    const BodyConfig& body, double blind_m) {
  const double sure_m = blind_m + kDubious_m, ends_m = sure_m + kBeyond_m;
  const Pose2 lidar_T_robot = robot_T_lidar.inverse();
  std::vector<Vector2> near;
  std::array<std::optional<Vector2>, Sight::kSectors> ends;
  for (const ObstaclePoint& p : points) {
    const Vector2 from_lidar = lidar_T_robot * Vector2(p.x_m, p.y_m);
    const double range_m = from_lidar.norm();
    if (range_m < sure_m || range_m >= ends_m + kPiece_m) continue;
    near.push_back(from_lidar);
    if (range_m < ends_m) ends[Sight::sector_of(from_lidar)] = from_lidar;
  }
  const auto go_on = [&](const Line& wall, std::size_t sector, std::size_t step) {
    for (;; sector += step) {
      const double angle = Sight::middle_rad(sector);
      const Vector2 direction(std::cos(angle), std::sin(angle));
      const auto range_m = range_to(wall, direction);
      if (!range_m || *range_m >= ends_m || sight.farthest_m(sector) > *range_m + kBehind_m) return;
      const Vector2 p = robot_T_lidar * (*range_m * direction);
      if (!is_deep_inside(body, p)) points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y())});
    }
  };
  for (std::size_t sector = 0; sector < Sight::kSectors; ++sector) {
    if (!ends[sector]) continue;
    for (const std::size_t step : {kLeft, kRight}) {
      if (ends[(sector + step) % Sight::kSectors]) continue;
      if (const auto wall = wall_at(*ends[sector], near)) go_on(*wall, sector + step, step);
    }
  }
}

}  // namespace dynslam
