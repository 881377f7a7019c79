// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "autopilot/order.h"
#include "base/config_field.h"
#include "base/time.h"
#include "drive/drive_task.h"
#include "drive/path_follower.h"
#include "plan/path_planner.h"

namespace dynslam {

/// Section [navigation] of the configuration.
struct NavigationConfig {
  double replan_s = 2.0;
  double patience_s = 15.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"replan_s", "so often a better route is looked for", 0.2, 60.0}, self.replan_s);
    visit(Field{"patience_s", "a way that is blocked is waited for so long", 0.0, 600.0}, self.patience_s);
  }
};

/// What the follower said last, of which errand.
struct FollowReport {
  std::uint64_t task = 0;
  Following state = Following::kIdle;
  double remaining_m = 0.0;
  std::vector<Vector2> route_map = {};  ///< what is left of it, from the robot on
  std::string reason = {};
};

/// Brings the robot to one destination: keeps a route to it good while the follower drives along it, and
/// knows when to wait, and when there is no way. What shut the way may be gone since it was seen: it drives
/// as near as it can come before it says so, and looks at another door, where there is one. Boxed in it makes
/// room once for who may be waiting for that. Pure; one thread.
class Navigator {
 public:
  enum class State {
    kIdle,
    kDriving,
    kWaiting,  ///< for the way to be free
    kArrived,
    kNoRoute,
    kStuck,  ///< the wheels turn and the robot stays
  };
  struct Report {
    State state = State::kIdle;
    std::string reason = {};
    std::optional<Vector2> nearest_map = {};  ///< kNoRoute: the point nearest to the destination that has one
  };

  Navigator(const NavigationConfig& config, PathPlanner& planner) : config_(config), planner_(planner) {}

  /// `stops` at the destination; otherwise coming by is enough. A way that is blocked is waited for so long.
  void set_out(const Destination& to, bool stops, std::optional<double> patience_s = std::nullopt);
  void give_up();
  /// The destination stays; the route is not driven on.
  void plan_anew();
  Report turn(Time now, const Pose2& map_T_robot, const Costmap& costmap, const FollowReport& follow);

  /// What the follower is to do; nothing: stand.
  const std::optional<DriveTask>& task() const { return task_; }
  const std::optional<Destination>& destination() const { return to_; }

 private:
  bool is_route_due(Time now, const Costmap& costmap, const FollowReport& follow) const;
  void plan(Time now, const Pose2& map_T_robot, const Costmap& costmap, const FollowReport& follow);
  bool is_arrival(Time now, const Pose2& map_T_robot, const FollowReport& follow);
  bool is_worth_a_look(const Plan& plan, const Vector2& robot_map) const;
  Plan approach(Plan plan, const Vector2& robot_map, const Costmap& costmap);
  bool is_better(const Plan& plan, const Costmap& costmap, const FollowReport& follow) const;
  bool is_blocked(const Costmap& costmap, const FollowReport& follow) const;
  Report without_route(Time now, const Pose2& map_T_robot, const Costmap& costmap,
                       const FollowReport& follow);
  Report held(Time now, const Pose2& map_T_robot, const std::string& reason);
  void note_nearness(Time now, const FollowReport& follow);
  bool is_near_enough(Time now, double off_m) const;
  bool is_patient(Time now, double most_s);
  bool gives_way(Time now, const Pose2& map_T_robot, const Costmap& costmap, const FollowReport& follow);
  bool may_come_up(const Vector2& robot_map, const Costmap& costmap) const;
  bool comes_up(Time now, const Pose2& map_T_robot, const Costmap& costmap, const FollowReport& follow);
  bool looks_elsewhere(Time now, const Pose2& map_T_robot, const Costmap& costmap,
                       const FollowReport& follow);
  bool sets_out_anew(Time now, const Pose2& map_T_robot, const Costmap& costmap, const FollowReport& follow);
  Report end(State state, const std::string& reason);

  NavigationConfig config_;
  PathPlanner& planner_;
  std::uint64_t errands_ = 0;
  std::optional<Destination> to_;
  bool stops_ = true;
  double patience_s_ = 0.0;
  bool had_route_ = false;
  bool was_free_ = false;           ///< the destination, to stand at
  std::optional<Time> near_since_;  ///< it is nearly at the end of its way
  bool approaches_ = false;         ///< the way that it knows of is shut: it drives there to look again
  bool looked_ = false;             ///< it did
  bool came_up_ = false;            ///< close to the door that it waits before
  bool gave_way_ = false;
  std::optional<Vector2> aside_map_;  ///< where it goes to make room, or to look from close by
  std::vector<Vector2> in_vain_;      ///< before which doors it waited
  int more_looks_ = 0;                ///< that it took after the first
  std::optional<Plan> last_plan_;
  std::optional<Time> planned_at_;
  std::optional<Time> held_up_since_;
  std::optional<DriveTask> task_;
};

}  // namespace dynslam
