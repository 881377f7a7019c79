// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "autopilot/autopilot.h"
#include "base/imu_sample.h"
#include "drive/back_off.h"
#include "drive/drive_config.h"
#include "drive/path_follower.h"
#include "drive/recent_motion.h"
#include "drive/speed_control.h"
#include "pipe/clock.h"
#include "pipe/latest.h"
#include "robot/ports.h"

namespace dynslam {

/// Lets the autopilot drive as a person would: by commands, through everything that guards a person's
/// commands. Two turns, each with a thread of its own: one plans, and may take as long as it needs; the other
/// keeps the commands coming and minds what is in the way.
class AutopilotStage {
 public:
  static constexpr Duration kPlanEvery = std::chrono::milliseconds(200);
  static constexpr Duration kCommandEvery = std::chrono::milliseconds(50);

  /// All references must outlive it.
  AutopilotStage(const AutopilotSetup& setup, const DriveConfig& drive, const Clock& clock, Ports& ports,
                 const Latest<ImuSample>& imu);

  void plan_turn();
  Time plan_due() const { return plan_due_; }
  void pilot_turn();
  Time pilot_due() const { return pilot_due_; }

 private:
  /// From the one turn to the other.
  struct Wanted {
    Time time;
    std::uint64_t errand = 0;
    bool drives = false;
    std::optional<DriveTask> task = {};
    double look_round_radps = 0.0;
    bool backs_off = false;
  };
  /// From the other to the one: what ends an errand, though it was over before the next plan.
  struct Interruption {
    std::uint64_t errand = 0;
    bool is_steered = false;  ///< a person took the wheel; otherwise it is the condition
    Condition condition = {};
  };
  Condition condition(const std::shared_ptr<const WorldState>& world) const;
  bool is_steered_by_others() const;
  void mind_interruptions(std::uint64_t errand);
  void let_go();
  void feel(Time now);
  void tell_of_glass(Time seen);
  void follow(const std::optional<DriveTask>& task);
  Twist wanted_twist(Time now, const Wanted& wanted);
  void command(Time now, const Twist& twist, bool gone);

  const Clock& clock_;
  Ports& ports_;
  const Latest<ImuSample>& imu_;

  // Of the planning turn.
  Autopilot autopilot_;
  Time plan_due_;
  std::uint64_t errand_ = 0;

  Latest<Wanted> wanted_;
  Latest<FollowReport> report_;
  Latest<Twist> came_;
  Latest<std::vector<Segment>> glass_map_;
  Latest<Interruption> interruption_;

  // Of the commanding turn.
  PathFollower follower_;
  SpeedControl speed_;
  BackOff back_off_;
  RecentMotion motion_;
  Time pilot_due_;
  std::uint64_t scan_version_ = 0;
  std::optional<DriveTask> followed_;
  std::optional<std::uint64_t> interrupted_;  ///< errand
  std::optional<DriveCommand> sent_;          ///< the last one; nothing while it does not drive
  std::shared_ptr<const WorldState> world_;
  bool touches_ = false;
  Twist applied_, measured_;
};

}  // namespace dynslam
