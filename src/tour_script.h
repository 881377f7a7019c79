// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "mission_script.h"
#include "robot/tour.h"
#include "sim/world.h"

namespace dynslam {

/// Drives a world's tour by commands, as a person would.
class TourScript : public MissionScript {
 public:
  TourScript(const World& world, int laps);

  /// Says nothing as long as somebody else drives.
  void yield_to(std::function<bool()> somebody_drives) { somebody_drives_ = std::move(somebody_drives); }

  std::optional<MissionEnd> turn(Time now, Ports& ports, Simulator& simulator) override;
  GoalCounts goals() const override;

 private:
  Tour tour_;
  std::function<bool()> somebody_drives_ = [] { return false; };
  std::uint64_t seq_ = 0;
};

/// Leaves the robot to the people who drive it.
class WaitingScript : public MissionScript {
 public:
  std::optional<MissionEnd> turn(Time, Ports&, Simulator&) override { return std::nullopt; }
};

}  // namespace dynslam
