// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "base/pose2.h"
#include "robot/ports.h"
#include "sim/simulator.h"

namespace dynslam {

/// How a robot that drives itself drives: what people notice. Looked at twenty times a second. The robot's
/// way is by its own map; where it stands, what is in its way and how near that is are the simulator's truth.
class DriveRecord {
 public:
  void note(Time now, const Ports& ports, Simulator& simulator);

  /// For report.json. `longest_wait_s`: that it stayed where it was though there was a way to its goal.
  /// A contact's `high_m` is how high that reaches which it touched: below kLidarHeight_m nobody sees it.
  /// `reversals_per_m`: how often it turned the other way; those while driving, and those of turns on the
  /// spot. `least_clearance_m`: between its body and anything but people, while it drove. And where all that
  /// was worst, in the frame of its start.
  nlohmann::json figures() const;

 private:
  /// The worst of its kind, when and where.
  struct Worst {
    double value = 0.0, time_s = 0.0;
    Pose2 map_T_robot;
  };
  void note_wait(Time now, const AutopilotStatus& status, Simulator& simulator);
  void note_turns(const Twist& twist);
  void note_room(Simulator& simulator);
  void note_contacts(Simulator& simulator);
  Worst here(double value) const { return {value, now_s_, truth_map_}; }
  static nlohmann::json place(const Worst& worst);
  double per_m(int count) const { return way_m_ > 0.0 ? count / way_m_ : 0.0; }

  std::optional<Time> begin_;
  double now_s_ = 0.0;
  Pose2 truth_map_;              ///< the robot now
  std::optional<Pose2> anchor_;  ///< where it stays,
  Time free_since_;              ///< and since when, with a way that is free
  Time free_checked_;
  Worst longest_wait_;
  Worst least_to_things_{Life::kMostRoom_m, 0.0, {}}, least_to_people_{Life::kMostRoom_m, 0.0, {}};
  int contacts_ = 0;
  nlohmann::json contact_places_ = nlohmann::json::array();

  double way_m_ = 0.0;
  int reversals_driving_ = 0, reversals_on_spot_ = 0;
  Twist last_turn_;  ///< the last that could be felt
  std::optional<Pose2> pose_;
};

}  // namespace dynslam
