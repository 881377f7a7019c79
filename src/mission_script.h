// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "robot/robot.h"
#include "sim/simulator.h"

namespace dynslam {

/// How a mission ended, as report.json says it.
struct MissionEnd {
  std::string result, reason;
};

struct GoalCounts {
  std::size_t tried = 0, reached = 0;
  std::size_t no_route_right = 0;  ///< it said that there is no route, and so it is
  std::size_t failed = 0;
};

/// What a simulated robot is asked to do, one thing after the other.
class MissionScript {
 public:
  MissionScript() = default;
  MissionScript(const MissionScript&) = delete;
  MissionScript& operator=(const MissionScript&) = delete;
  virtual ~MissionScript() = default;

  /// Twenty times a second: asks for what is next; returns how the mission ended, once it has. What the
  /// simulator knows is for judging alone.
  virtual std::optional<MissionEnd> turn(Time now, Ports& ports, Simulator& simulator) = 0;
  virtual GoalCounts goals() const { return {}; }
  /// More for report.json.
  virtual nlohmann::json details() const { return nlohmann::json::object(); }
};

}  // namespace dynslam
