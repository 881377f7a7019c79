// SPDX-License-Identifier: MIT
#include "slam/match_points.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr std::size_t kMostPoints = 2000;
/// Ends this far apart, in cells, are dots on their surface.
constexpr double kDots = 2.5;
/// Three ends are on one surface when the middle one lies this near the line, as a share of its length.
constexpr double kStraight = 0.15;

/// Across the surface that three neighbouring ends lie on, where they are dots on a straight one.
Vector2 normal_of_dots(const RayEnd& before, const RayEnd& end, const RayEnd& after, double cell_size_m) {
  if (!before.hit || !after.hit) return Vector2::Zero();
  const Vector2 from(before.x_m, before.y_m), whole = Vector2(after.x_m, after.y_m) - from;
  const double length = whole.norm();
  if (length < 2 * kDots * cell_size_m) return Vector2::Zero();
  const Vector2 normal(-whole.y() / length, whole.x() / length), part = Vector2(end.x_m, end.y_m) - from;
  const double along = whole.dot(part) / length;
  const bool straight = std::abs(normal.dot(part)) < kStraight * length && along > 0 && along < length;
  return straight ? normal : Vector2::Zero();
}

}  // namespace

void choose_points(const CorrectedScan& scan, double cell_size_m, std::vector<MatchPoint>& points) {
  const double c = std::cos(scan.robot_T_lidar.yaw), s = std::sin(scan.robot_T_lidar.yaw);
  const Vector2 at = scan.robot_T_lidar.translation() / cell_size_m;
  const std::vector<RayEnd>& ends = scan.ends_lidar;
  const std::size_t stride = 1 + ends.size() / kMostPoints;
  const double arc_cells = static_cast<double>(stride) * scan.beam_step_rad / cell_size_m;
  points.clear();
  for (std::size_t i = 0; i < ends.size(); i += stride) {
    const RayEnd& e = ends[i];
    if (!e.hit) continue;
    const Vector2 n = i > 0 && i + 1 < ends.size() ? normal_of_dots(ends[i - 1], e, ends[i + 1], cell_size_m)
                                                   : Vector2(Vector2::Zero());
    points.push_back({static_cast<float>(at.x() + (c * e.x_m - s * e.y_m) / cell_size_m),
                      static_cast<float>(at.y() + (s * e.x_m + c * e.y_m) / cell_size_m),
                      static_cast<float>(std::min(1.0, arc_cells * e.range_m)),
                      static_cast<float>(c * n.x() - s * n.y()), static_cast<float>(s * n.x() + c * n.y())});
  }
}

}  // namespace dynslam
