// SPDX-License-Identifier: MIT
#pragma once

#include "sim/surface.h"

namespace dynslam {

/// The simulated robot, of the MonsterBorg's size.
inline constexpr double kRobotLength_m = 0.25, kRobotWidth_m = 0.22;
/// Things whose heights lie between these stop it; lower ones it drives over, higher ones it passes under.
inline constexpr double kRobotLow_m = 0.02, kRobotHigh_m = 0.21;
inline constexpr double kLidarHeight_m = 0.18;

/// Whether the robot at a pose touches a face.
bool robot_touches(const Pose2& world_T_robot, const Surface& surface);

/// How far a face is from the robot, infinitely where it passes over or under it; 0 when they touch.
double distance_to_robot(const Pose2& world_T_robot, const Surface& surface);

/// How far a point is from the robot; 0 within it.
double distance_to_robot(const Pose2& world_T_robot, const Vector2& p);

/// How far a segment is from the robot; 0 when they touch.
double distance_to_robot(const Pose2& world_T_robot, const Vector2& from, const Vector2& to);

}  // namespace dynslam
