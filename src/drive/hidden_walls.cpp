// SPDX-License-Identifier: MIT
#include "drive/hidden_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>

#include "drive/line_fit.h"

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

/// Nothing when what is seen is too short or crooked.
std::optional<Line> wall_at(const Vector2& end, const std::vector<Vector2>& near) {
  std::vector<Vector2> piece;
  std::copy_if(near.begin(), near.end(), std::back_inserter(piece),
               [&end](const Vector2& p) { return (p - end).norm() < kPiece_m; });
  if (piece.size() < kLeastPoints) return std::nullopt;
  const Line line = line_through(piece);
  if (line.across_m > kStraight_m || line.length_m < kLeastLength_m) return std::nullopt;
  return line;
}

}  // namespace

void continue_walls(std::vector<ObstaclePoint>& points, const Look& look, const BodyConfig& body,
                    double blind_m) {
  const double sure_m = blind_m + kDubious_m, ends_m = sure_m + kBeyond_m;
  const Pose2 lidar_T_robot = look.robot_T_lidar.inverse();
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
      if (!range_m || *range_m >= ends_m || look.sight.farthest_m(sector) > *range_m + kBehind_m) return;
      const Vector2 p = look.robot_T_lidar * (*range_m * direction);
      if (!body.contains(p, BodyConfig::kMayBeSmaller_m))
        points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y())});
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
