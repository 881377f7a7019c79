// SPDX-License-Identifier: MIT
#pragma once

namespace dynslam {

/// How the robot stands and turns, as its IMU tells: angles of z-y-x Euler, so that roll is positive with the
/// right side down, pitch with the nose down, the rate to the left.
struct Attitude {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_radps = 0.0;
};

}  // namespace dynslam
