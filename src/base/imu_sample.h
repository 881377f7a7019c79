// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "base/time.h"

namespace dynslam {

/// A fused orientation from the IMU. `world_q_robot` turns robot axes (x forward, y left, z up) into a level
/// frame whose heading is arbitrary, constant up to slow drift, and not the map's. Unit length, finite.
struct ImuSample {
  Time stamp;
  Eigen::Quaterniond world_q_robot = Eigen::Quaterniond::Identity();
};

/// Heading about the vertical axis, in [-pi, pi] (z of the z-y-x Euler angles).
inline double yaw_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

}  // namespace dynslam
