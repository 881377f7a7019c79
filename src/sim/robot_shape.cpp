// SPDX-License-Identifier: MIT
#include "sim/robot_shape.h"

#include <algorithm>
#include <limits>

namespace dynslam {
namespace {

constexpr double kHalfLength = kRobotLength_m / 2, kHalfWidth = kRobotWidth_m / 2;

/// Whether a segment in the robot's frame has a point in its rectangle (Liang and Barsky, 1984).
bool enters_rectangle(const Vector2& from, const Vector2& along) {
  double enter = 0.0, leave = 1.0;
  const auto clip = [&](double start, double delta, double half) {
    if (delta == 0) return std::abs(start) <= half;
    const double a = (-half - start) / delta, b = (half - start) / delta;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
    return enter <= leave;
  };
  return clip(from.x(), along.x(), kHalfLength) && clip(from.y(), along.y(), kHalfWidth);
}

double distance_to_rectangle(const Vector2& p_robot) {
  return std::hypot(std::max(0.0, std::abs(p_robot.x()) - kHalfLength),
                    std::max(0.0, std::abs(p_robot.y()) - kHalfWidth));
}

}  // namespace

bool robot_touches(const Pose2& world_T_robot, const Surface& surface) {
  if (surface.low_m >= kRobotHigh_m || surface.high_m <= kRobotLow_m) return false;
  const Pose2 robot_T_world = world_T_robot.inverse();
  const Vector2 from = robot_T_world * surface.from;
  if (surface.radius_m > 0) return distance_to_rectangle(from) < surface.radius_m;
  return enters_rectangle(from, robot_T_world * Vector2(surface.from + surface.along) - from);
}

double distance_to_robot(const Pose2& world_T_robot, const Surface& surface) {
  if (surface.low_m >= kRobotHigh_m || surface.high_m <= kRobotLow_m)
    return std::numeric_limits<double>::infinity();
  if (surface.radius_m > 0)
    return std::max(0.0, distance_to_robot(world_T_robot, surface.from) - surface.radius_m);
  return distance_to_robot(world_T_robot, surface.from, surface.from + surface.along);
}

double distance_to_robot(const Pose2& world_T_robot, const Vector2& p) {
  return distance_to_rectangle(world_T_robot.inverse() * p);
}

double distance_to_robot(const Pose2& world_T_robot, const Vector2& from, const Vector2& to) {
  const Pose2 robot_T_world = world_T_robot.inverse();
  const Vector2 a = robot_T_world * from, b = robot_T_world * to;
  if (enters_rectangle(a, b - a)) return 0.0;
  const Polygon corners = rectangle({}, kRobotLength_m, kRobotWidth_m);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    nearest = std::min(nearest, distance_between_segments(a, b, corners[i], corners[(i + 1) % 4]));
  }
  return nearest;
}

}  // namespace dynslam
