// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "base/pose2.h"
#include "base/time.h"

namespace dynslam {

struct StampedPose {
  Time stamp;
  Pose2 map_T_robot;
};

/// `t x y z qx qy qz qw` a line (the format of the TUM RGB-D benchmark), seconds and metres; enough digits
/// for the nanosecond and the micrometre. Locale-independent.
std::string to_tum(const std::vector<StampedPose>& trajectory);

}  // namespace dynslam
