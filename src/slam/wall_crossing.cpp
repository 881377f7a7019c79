// SPDX-License-Identifier: MIT
#include "slam/wall_crossing.h"

#include <algorithm>

namespace dynslam {
namespace {

constexpr std::size_t kLooks = 120;
constexpr double kBesideLidar_m = 0.3;
/// A wall is some cells thick, and grazing beams run along it.
constexpr double kBeforeEnd_m = 0.2;

bool is_beside_hit(const ChunkedGrid& map, CellIndex c) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (map.hit({c.x + dx, c.y + dy}) > 0) return true;
    }
  }
  return false;
}

/// Cells. A step of one cell may slip between two that touch at their corners: of some beams in a hundred.
bool crosses_wall(const ChunkedGrid& map, const Vector2& from, const Vector2& to) {
  const double length = (to - from).norm(), cell = map.cell_size_m();
  const Vector2 step = (to - from) / length;
  for (double way = kBesideLidar_m / cell; way < length - kBeforeEnd_m / cell; way += 1.0) {
    const CellIndex c = cell_at(from + way * step, 1.0);
    if (map.hit(c) > 0 && map.state(c) == CellState::kOccupied) return true;
  }
  return false;
}

}  // namespace

double share_through_walls(const ChunkedGrid& map, std::span<const MatchPoint> points_robot,
                           const Pose2& map_T_robot, const Vector2& lidar_robot) {
  const double cell = map.cell_size_m();
  const Pose2 cells_T_robot{map_T_robot.x / cell, map_T_robot.y / cell, map_T_robot.yaw};
  const Vector2 lidar = cells_T_robot * Vector2(lidar_robot / cell);
  const std::size_t step = std::max<std::size_t>(1, points_robot.size() / kLooks);
  int looks = 0, through = 0;
  for (std::size_t i = 0; i < points_robot.size(); i += step, ++looks) {
    const Vector2 end = cells_T_robot * Vector2(points_robot[i].x, points_robot[i].y);
    if (is_beside_hit(map, cell_at(end, 1.0))) continue;
    through += crosses_wall(map, lidar, end) ? 1 : 0;
  }
  return looks > 0 ? static_cast<double>(through) / looks : 0.0;
}

}  // namespace dynslam
