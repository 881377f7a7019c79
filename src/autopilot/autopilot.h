// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "autopilot/autopilot_config.h"
#include "autopilot/explorer.h"
#include "autopilot/felt_obstacles.h"
#include "autopilot/glass_map.h"
#include "autopilot/hindrance.h"
#include "autopilot/navigator.h"
#include "autopilot/status.h"
#include "grid/world_state.h"
#include "plan/costmap.h"

namespace dynslam {

/// All that can be set about driving by itself.
struct AutopilotSetup {
  AutopilotConfig autopilot;
  NavigationConfig navigation;
  ExplorationConfig exploration;
  PlannerConfig planner;
  double robot_radius_m = 0.2;
};

/// What an autopilot goes by.
struct AutopilotInputs {
  std::span<const Order> orders;               ///< new ones
  std::shared_ptr<const WorldState> world;     ///< null: none yet
  std::shared_ptr<const MapNotes> notes = {};  ///< null: none
  FollowReport follow = {};
  Condition condition = {};
  bool is_steered = false;                  ///< a person drives
  Twist came = {};                          ///< how it moved when it last moved
  std::span<const Segment> glass_map = {};  ///< panes that it sees
};

/// Decides where to drive (thesis, chapter 6): navigation brings the robot to a place that people chose,
/// exploration chooses places itself, until all is seen; then it visits what was not seen for longest. Three
/// states: it drives, has nothing to do, or stopped and says why. People always have precedence: who takes
/// the wheel ends what it does.
///
/// Pure: called some times a second, with the time. The route it wants is for a PathFollower. One thread.
class Autopilot {
 public:
  explicit Autopilot(const AutopilotSetup& setup);

  const AutopilotStatus& turn(Time now, const AutopilotInputs& in);

  /// What is to be driven; nothing: stand, or turn() says to look round.
  const std::optional<DriveTask>& task() const { return navigator_.task(); }
  /// On the spot, to find out where it is; 0: no need.
  double look_round_radps() const { return look_round_radps_; }
  bool is_on() const { return status_.phase != AutopilotPhase::kOff; }
  /// The way that it came, a little.
  bool backs_off() const { return backs_off_until_.has_value(); }
  /// Nothing that can be reached is left to be seen for the first time.
  bool is_explored() const { return explored_ || explorer_.is_over(); }

 private:
  bool explores() const { return std::holds_alternative<Explore>(errand_); }
  void take(Time now, const Order& order);
  void observe(Time now, const AutopilotInputs& in);
  void drive(Time now, const AutopilotInputs& in);
  bool bear(Time now, const AutopilotInputs& in, const Hindrance& hindrance);
  bool free_itself(Time now, const AutopilotInputs& in, const std::optional<Hindrance>& hindrance);
  void back_off(Time now, const AutopilotInputs& in, const std::string& from);
  void stuck(Time now, const AutopilotInputs& in);
  void keep_out();
  void trust();
  bool set_out(Time now, const Vector2& robot_map);
  bool explore(Time now, const Vector2& robot_map);
  void finish_exploring();
  void set_out_to(const Destination& to, bool stops, std::optional<double> patience_s = std::nullopt);
  void arrived(Time now, const std::string& remark);
  void failed(Time now, const Navigator::Report& report);
  void go_home();
  void end(AutopilotPhase phase, const std::string& reason);
  void show(Time now, const AutopilotInputs& in);

  AutopilotConfig config_;
  double robot_radius_m_;
  PathPlanner planner_;
  Navigator navigator_;
  Explorer explorer_;
  std::optional<Costmap> costmap_;  ///< from the first map on
  std::optional<Time> mapped_at_;   ///< when it was updated last
  std::shared_ptr<const MapNotes> notes_;
  FeltObstacles felt_;
  GlassMap glass_;
  std::optional<Time> backs_off_until_;

  Order errand_ = SwitchOff{};
  Time ordered_at_;
  bool flees_ = false;               ///< goes home to be charged
  std::size_t stop_ = 0;             ///< of a patrol
  std::size_t failed_stops_ = 0;     ///< one after the other
  std::optional<Time> rests_until_;  ///< at a stop
  std::optional<Time> hindered_since_;
  bool explored_ = false;
  double look_round_radps_ = 0.0;
  AutopilotStatus status_;
};

}  // namespace dynslam
