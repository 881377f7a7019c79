// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "autopilot/order.h"
#include "base/pose2.h"
#include "base/time.h"

namespace dynslam {

/// The thesis's two states: it drives to a place, or finds out what there is.
enum class AutopilotMode : std::uint8_t { kNavigation, kExploration };

enum class AutopilotPhase : std::uint8_t {
  kOff,      ///< people drive
  kActive,   ///< it drives, or waits for the way to be free
  kIdle,     ///< nothing to do
  kStopped,  ///< it cannot go on by itself, see the reason
};

/// What it may visit next.
struct PlaceShown {
  std::string_view kind;  ///< "frontier", "unvisited" or "old"
  Vector2 point_map;
};

/// How it stands with the autopilot, for people.
struct AutopilotStatus {
  Time time;
  AutopilotMode mode = AutopilotMode::kNavigation;
  AutopilotPhase phase = AutopilotPhase::kOff;
  std::string reason;               ///< why it does not drive, or what it waits for; empty while it drives
  std::optional<Destination> goal;  ///< where it drives to
  std::vector<Vector2> route_map;   ///< what is left of it, from the robot on
  std::optional<double> remaining_m;
  std::vector<PlaceShown> places;
  std::optional<Vector2> nearest_map;  ///< when there is no route: the point nearest to the goal that has one
  std::uint64_t errand = 0;            ///< counts what it was asked for
};

}  // namespace dynslam
