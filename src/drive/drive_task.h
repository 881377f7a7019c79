// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/pose2.h"

namespace dynslam {

/// What the autopilot wants driven.
struct DriveTask {
  std::uint64_t id = 0;            ///< another number: another errand; the same: the route was made anew
  std::vector<Vector2> route_map;  ///< from where the robot is to the goal; straight legs
  std::optional<double> yaw_rad;   ///< to face at the end, in the map's frame
  double most_mps = 0.5;           ///< speed limit
  bool stops_at_end = true;        ///< comes to rest at the end; else passing near it is enough
  bool operator==(const DriveTask&) const = default;
};

}  // namespace dynslam
