// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "robot/recorder_event.h"

namespace dynslam {

/// Decides what of a robot's events becomes which message of a recording, and adds what is told by the clock:
/// the battery, how devices are doing and the autopilot's route every second, what the autopilot is about
/// when that changes, the map every ten seconds. One for each file; one thread.
class EventWriter {
 public:
  /// Both must outlive it.
  EventWriter(RosWriter& ros, Ports& ports) : ros_(ros), ports_(ports) {}

  void write(const RecorderEvent& event);
  /// What is due by the clock.
  void look(Time now);
  /// The map as it is at the end.
  void finish(Time now) { write_map(now); }

  /// A map of more cells is recorded with larger ones.
  static constexpr std::size_t kMostMapCells = 4 << 20;

 private:
  void write_drive(Time now, const DriveState& drive);
  void write_map(Time now);
  void write_health(Time now);
  void write_autopilot(Time now, bool is_due);

  RosWriter& ros_;
  Ports& ports_;
  Time health_due_, map_due_, battery_due_;
  std::optional<Verdict> verdict_;
  std::optional<BatteryState> battery_;
  std::optional<PoseEstimate> pose_;
  std::optional<std::size_t> map_hash_;
  std::string autopilot_about_, autopilot_reason_;
};

}  // namespace dynslam
