// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>

#include "base/pose2.h"

namespace dynslam {

/// A pose within `metres` and `radians` of another, turns counted the short way.
MATCHER_P3(PoseNear, expected, metres, angle_rad, "") {
  const double distance = (arg.translation() - expected.translation()).norm();
  const double turned = std::abs(turn(expected.yaw, arg.yaw));
  *result_listener << "which is (" << arg.x << ", " << arg.y << ", " << arg.yaw << "), " << distance
                   << " m and " << turned << " rad off";
  return distance <= metres && turned <= angle_rad;
}

inline void PrintTo(const Pose2& p, std::ostream* out) {
  *out << "(" << p.x << ", " << p.y << ", " << p.yaw << ")";
}

}  // namespace dynslam
