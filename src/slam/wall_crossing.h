// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "base/pose2.h"
#include "grid/chunked_grid.h"
#include "slam/hit_window.h"

namespace dynslam {

/// The share of a scan's points, 0 to 1, that the lidar could only have seen through walls of the map, were
/// the robot at this pose: their beams cross an occupied cell well before they end, and where they end there
/// is no hit. People, open doors and moved furniture do not look like this, another place does. Some hundred
/// points, evenly spread, are looked at.
///
/// `points_robot` in cells, robot frame; `lidar_robot` in metres.
double share_through_walls(const ChunkedGrid& map, std::span<const MatchPoint> points_robot,
                           const Pose2& map_T_robot, const Vector2& lidar_robot);

}  // namespace dynslam
