// SPDX-License-Identifier: MIT
#pragma once

#include "base/pose2.h"
#include "base/time.h"

namespace dynslam {

/// Where the wheels say the robot is, in a frame of their own that drifts without bound.
struct OdometrySample {
  Time stamp;
  Pose2 odom_T_robot;
};

}  // namespace dynslam
