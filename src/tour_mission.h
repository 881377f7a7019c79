// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "config.h"
#include "robot/mapping_result.h"
#include "robot/robot.h"
#include "robot/tour.h"
#include "sim/simulator.h"

namespace dynslam {

struct TourMissionOptions {
  World world;
  std::uint64_t seed = 1;
  int laps = 1;                    ///< how often the tour is driven
  std::optional<double> limit_s;   ///< most of simulated time
  bool keeps_trajectories = true;  ///< otherwise memory does not grow with the hours
  bool waits = false;              ///< for people to drive, and drives no tour
};

/// How a mission ended, as report.json says it.
struct MissionEnd {
  std::string result, reason;
};

/// A simulated robot on a tour of its world, and what is noted on the way: its path as it knew it and as it
/// truly was.
class TourMission {
 public:
  /// `clock` must outlive it.
  TourMission(const TourMissionOptions& options, const Config& config, const Clock& clock);

  /// Says nothing as long as somebody else drives.
  void yield_to(std::function<bool()> somebody_drives) { somebody_drives_ = std::move(somebody_drives); }

  Robot& robot() { return robot_; }
  Simulator& simulator() { return *simulator_; }
  double passed_s() const { return to_seconds(clock_.now() - begin_); }
  double limit_s() const { return limit_s_; }
  std::size_t scans() const { return scans_; }
  Time next_command() const { return next_command_; }

  /// Says what to drive, when that is due; returns how the mission ended, once it has.
  std::optional<MissionEnd> turn();

  /// Ends the mapping; what is left is in `result`. Returns what report.json says of the mission. REQUIRES:
  /// the robot stopped.
  nlohmann::json finish(const MissionEnd& end);

  /// In the frame that the robot's map has: its start.
  std::vector<StampedPose> truth_map() const;

  MappingResult result;

 private:
  void fetch_truth(Time now);
  std::string skipped_text() const;
  double reachable_floor_mapped();
  nlohmann::json verdicts() const;

  const Clock& clock_;
  Time begin_, next_command_, next_truth_;
  double limit_s_;
  bool keeps_trajectories_, waits_;
  std::function<bool()> somebody_drives_ = [] { return false; };
  std::shared_ptr<Simulator> simulator_;
  Robot robot_;
  Tour tour_;
  std::size_t scans_ = 0;
  std::uint64_t seq_ = 0;
  std::vector<TruePose> truth_;
};

}  // namespace dynslam
