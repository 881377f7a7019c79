// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "drive/body_config.h"
#include "drive/obstacle_points.h"
#include "drive/sight.h"

namespace dynslam {

/// A wall beside the robot is seen as far as it is not too near for the lidar. What is hidden of it may be
/// what a corner of the robot runs into: it is taken to go on straight, in those directions from which
/// nothing comes back. Adds it to the points of a scan, which are from the robot.
void continue_walls(std::vector<ObstaclePoint>& points, const Look& look, const BodyConfig& body,
                    double blind_m);

}  // namespace dynslam
