// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "base/pose2.h"
#include "base/time.h"

namespace dynslam {

/// One measurement of the lidar, in its own frame: x forward, angles counter-clockwise.
struct Beam {
  float angle_rad = 0.0F;
  float range_m =
      std::numeric_limits<float>::quiet_NaN();  ///< +inf: nothing came back; NaN: no valid measurement
  float time_s = 0.0F;                          ///< after the scan's stamp
};

inline bool is_return(const Beam& b) { return std::isfinite(b.range_m); }

/// Where the lidar sits on the robot.
struct LidarMount {
  Pose2 robot_T_lidar;
  bool upside_down = false;  ///< rolled by pi about its x axis: its angles run clockwise seen from above
  double height_m = 0.18;    ///< of its plane above the floor
};

/// One turn of the lidar, beams in the order they were measured.
struct Scan {
  Time stamp;  ///< of the first beam
  std::vector<Beam> beams;
  LidarMount mount;
};

}  // namespace dynslam
