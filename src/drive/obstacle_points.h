// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "base/scan.h"
#include "drive/body_config.h"
#include "drive/recent_motion.h"

namespace dynslam {

struct ObstaclePoint {
  float x_m, y_m;
};

/// When the last beam of a scan was taken. Beams that claim to be more than a second after its stamp, or
/// before it, are taken at its stamp.
Time end_of(const Scan& scan);

/// The returns of a scan where they lie from the robot at the scan's end, each carried along by how the robot
/// moved since its beam. Left out: what is nearer than `min_range_m` or within the robot's own body, and lone
/// points, which are noise: a real thing that is near shows in neighbouring beams.
std::vector<ObstaclePoint> obstacle_points(const Scan& scan, const BodyConfig& body, double min_range_m,
                                           const RecentMotion& motion);

}  // namespace dynslam
