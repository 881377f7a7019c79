// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "base/pose2.h"
#include "base/time.h"

namespace dynslam {

/// Why a scan was matched, but smeared too much to be drawn.
enum class Unsteady : std::uint8_t { kNo, kTurning, kTilting };

/// Where the robot believes to be in its map.
struct PoseEstimate {
  Time stamp;
  Pose2 map_T_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, yaw): m2, m rad, rad2
  double quality = 0.0;                                  ///< 0 to 1: how far it is to be trusted
  bool lost = false;
  Unsteady unsteady = Unsteady::kNo;  ///< of the scan that it comes from
};

}  // namespace dynslam
