// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "config.h"
#include "drive_record.h"
#include "mission_script.h"
#include "robot/mapping_result.h"
#include "robot/robot.h"
#include "sim/simulator.h"

namespace dynslam {

struct SimMissionOptions {
  World world;
  std::uint64_t seed = 1;
  std::optional<double> limit_s;   ///< most of simulated time
  bool keeps_trajectories = true;  ///< otherwise memory does not grow with the hours
  StageWatch* watch = nullptr;     ///< of the robot: see there
};

/// A simulated robot on a mission, and what is noted on the way: its path as it knew it and as it truly was.
class SimMission {
 public:
  /// `clock` must outlive it.
  SimMission(const SimMissionOptions& options, std::unique_ptr<MissionScript> script, const Config& config,
             const Clock& clock);

  Robot& robot() { return robot_; }
  Simulator& simulator() { return *simulator_; }
  double passed_s() const { return to_seconds(clock_.now() - begin_); }
  double limit_s() const { return limit_s_; }
  std::size_t scans() const { return scans_; }
  Time next_turn() const { return next_turn_; }

  /// Goes on with the script, when that is due; returns how the mission ended, once it has.
  std::optional<MissionEnd> turn();

  /// Ends the mapping; what is left is in `result`. Returns what report.json says of the mission. REQUIRES:
  /// the robot stopped.
  nlohmann::json finish(const MissionEnd& end);

  /// In the frame that the robot's map has: its start.
  std::vector<StampedPose> truth_map() const;

  MappingResult result;

 private:
  void fetch_truth(Time now);
  double reachable_floor_mapped();
  nlohmann::json verdicts() const;

  const Clock& clock_;
  Time begin_, next_turn_, next_truth_;
  double limit_s_;
  bool keeps_trajectories_;
  std::unique_ptr<MissionScript> script_;
  std::shared_ptr<Simulator> simulator_;
  Robot robot_;
  DriveRecord driving_;
  std::size_t scans_ = 0;
  std::vector<TruePose> truth_;
};

}  // namespace dynslam
