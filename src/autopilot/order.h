// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/pose2.h"

namespace dynslam {

/// A point to be at, in the map, and where to face there if that matters.
struct Destination {
  Vector2 point_map = Vector2::Zero();
  std::optional<double> yaw_rad = {};
  std::string name = {};  ///< of the place, when it has one
  bool operator==(const Destination&) const = default;
};

/// Drive there.
struct GoThere {
  Destination to;
};
/// Drive back to where the map began, or to the place that was made home.
struct GoHome {};
/// Find out what is there, then keep the map fresh.
struct Explore {};
/// Visit one after the other, again and again.
struct Patrol {
  std::vector<Destination> stops;
};
/// The autopilot is on, and waits for something to do.
struct StandBy {};
/// The autopilot is off: people drive.
struct SwitchOff {};

/// What people ask of the autopilot; each ends what was asked before it.
using Order = std::variant<SwitchOff, StandBy, GoThere, GoHome, Explore, Patrol>;

/// What people drew on the map.
struct MapNotes {
  std::vector<std::vector<Vector2>> forbidden_map;  ///< outlines of areas that the robot keeps out of
  std::optional<Destination> home = {};             ///< otherwise where the map began
};

}  // namespace dynslam
