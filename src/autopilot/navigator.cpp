// SPDX-License-Identifier: MIT
#include "autopilot/navigator.h"

#include <algorithm>
#include <utility>

namespace dynslam {
namespace {

/// A route that turned out to be blocked is not made anew more often than this.
constexpr Duration kReplanSoon = std::chrono::milliseconds(400);
/// Whoever stands in the only way when the robot wants to set out gets so long to step aside.
constexpr double kFirstPatience_s = 3.0;
/// A new route must be shorter by so much, or the robot would waver between two ways round.
constexpr double kBetter = 0.9;
/// Who stands at the destination gets so long to step aside.
constexpr double kStepsAside_s = 8.0;
/// A route's end is not farther away when its follower has arrived there.
constexpr double kAtEnd_m = 0.5;
/// So near to a destination there is hardly more than the heading left to do.
constexpr double kThere_m = 0.05;
/// Who passes by is gone sooner.
constexpr Duration kHeldUp = std::chrono::seconds(1);
/// Boxed in for so long, it makes room: before the first patience is over.
constexpr Duration kMakesRoom = std::chrono::seconds(2);
/// In a pocket no way is longer; and it is worth to go so much farther from the way out.
constexpr double kPocket_m = 2.5, kRoom_m = 0.4;
/// So near to a door it keeps the leaf from moving.
constexpr double kDoorway_m = 0.8;
/// Farther away it is not before that door.
constexpr double kBesideDoor_m = 2.0;
/// When a door stays shut, so many times more it goes and looks.
constexpr int kMoreLooks = 2;
/// To look whether the way is still shut, it is not worth to drive less far.
constexpr double kWorthLooking_m = 1.0;
/// The follower knows how fast it drives.
constexpr double kNoLimit_mps = 100.0;

/// What stands in the way may go; this does not.
bool is_hopeless(const Costmap& costmap, const Vector2& goal_map) {
  if (!goal_map.allFinite() || !costmap.contains(goal_map)) return true;
  return costmap.state(goal_map) == CellState::kUnknown ||
         costmap.is_forbidden(cell_at(goal_map, costmap.cell_size_m()));
}

}  // namespace

void Navigator::set_out(const Destination& to, bool stops, std::optional<double> patience_s) {
  give_up();
  ++errands_;
  to_ = to;
  stops_ = stops;
  patience_s_ = patience_s.value_or(config_.patience_s);
}

void Navigator::give_up() {
  to_.reset();
  task_.reset();
  last_plan_.reset();
  planned_at_.reset();
  held_up_since_.reset();
  near_since_.reset();
  had_route_ = was_free_ = approaches_ = looked_ = came_up_ = gave_way_ = false;
  aside_map_.reset();
  in_vain_.clear();
  more_looks_ = 0;
}

void Navigator::plan_anew() {
  task_.reset();
  planned_at_.reset();
  held_up_since_.reset();
}

Navigator::Report Navigator::turn(Time now, const Pose2& map_T_robot, const Costmap& costmap,
                                  const FollowReport& follow) {
  if (!to_) return {};
  note_nearness(now, follow);
  const bool is_news = task_ && follow.task == task_->id;
  const bool arrives = is_news && is_arrival(now, map_T_robot, follow);
  if (arrives && approaches_) {
    looked_ = true;
    aside_map_.reset();
    plan_anew();
  } else if (arrives) {
    return end(State::kArrived,
               last_plan_->outcome == PlanOutcome::kNearby ? last_plan_->reason : follow.reason);
  }
  if (is_news && follow.state == Following::kStuck) return end(State::kStuck, follow.reason);
  if (is_route_due(now, costmap, follow)) plan(now, map_T_robot, costmap, follow);
  if (!task_) return without_route(now, map_T_robot, costmap, follow);
  if (is_news && (follow.state == Following::kBlocked || follow.state == Following::kWaiting))
    return held(now, map_T_robot, follow.reason);
  if (!near_since_) held_up_since_.reset();
  if (near_since_ && is_news && follow.state == Following::kArrived)
    return {State::kWaiting, last_plan_->reason};
  return {State::kDriving};
}

Navigator::Report Navigator::without_route(Time now, const Pose2& map_T_robot, const Costmap& costmap,
                                           const FollowReport& follow) {
  if (is_hopeless(costmap, to_->point_map)) return end(State::kNoRoute, last_plan_->reason);
  if (gives_way(now, map_T_robot, costmap, follow)) return {State::kDriving};
  const bool may_come_up = this->may_come_up(map_T_robot.translation(), costmap);
  const bool is_for_part = may_come_up || !last_plan_->is_cut_off;
  const bool waits =
      (!may_come_up || last_plan_->sees_door) &&
      is_patient(now, is_for_part ? kStepsAside_s : patience_s_ - (came_up_ ? kStepsAside_s : 0.0));
  if (waits) return {State::kWaiting, last_plan_->reason};
  if (may_come_up && comes_up(now, map_T_robot, costmap, follow)) return {State::kDriving};
  if (looks_elsewhere(now, map_T_robot, costmap, follow)) return {State::kDriving};
  return end(State::kNoRoute, last_plan_->reason);
}

Navigator::Report Navigator::held(Time now, const Pose2& map_T_robot, const std::string& reason) {
  const double off_m = (to_->point_map - map_T_robot.translation()).norm();
  if (is_near_enough(now, off_m)) return end(State::kArrived, reason);
  if (is_patient(now, patience_s_)) return {State::kWaiting, reason};
  if (approaches_) {
    looked_ = true;  // from where it is
    aside_map_.reset();
    plan_anew();
    return {State::kWaiting, reason};
  }
  const bool is_there = near_since_ && off_m <= planner_.goal_tolerance_m();
  return end(is_there ? State::kArrived : State::kNoRoute, reason);
}

/// It is driving the last of its way, or stands at its end. Whoever stands there gets his time once, however
/// often the robot stirs.
void Navigator::note_nearness(Time now, const FollowReport& follow) {
  const bool is_near =
      task_ && follow.task == task_->id && stops_ && !approaches_ && follow.remaining_m <= kAtEnd_m;
  if (!is_near) near_since_.reset();
  if (is_near && (!near_since_ || now < *near_since_)) near_since_ = now;
}

/// Where something holds it that does not go away, a place beside its destination will do.
bool Navigator::is_near_enough(Time now, double off_m) const {
  const bool is_held = held_up_since_ && now - *held_up_since_ >= kHeldUp;
  const bool had_time = near_since_ && now - *near_since_ > from_seconds(kStepsAside_s);
  return is_held && had_time && off_m > kThere_m && off_m <= planner_.goal_tolerance_m();
}

/// At the destination; or as near as it can come, and whoever stood there had time to go.
bool Navigator::is_arrival(Time now, const Pose2& map_T_robot, const FollowReport& follow) {
  const bool is_there = follow.state == Following::kArrived &&
                        (task_->route_map.back() - map_T_robot.translation()).norm() <= kAtEnd_m;
  const bool may_get_free =
      stops_ && was_free_ && !approaches_ && last_plan_->outcome == PlanOutcome::kNearby;
  if (!is_there || !may_get_free || !near_since_) return is_there;
  return now - *near_since_ > from_seconds(kStepsAside_s);
}

/// On time, and at once when the route ends in something.
bool Navigator::is_route_due(Time now, const Costmap& costmap, const FollowReport& follow) const {
  if (!planned_at_ || now < *planned_at_ || now >= *planned_at_ + from_seconds(config_.replan_s)) return true;
  if (now < *planned_at_ + kReplanSoon) return false;
  return !task_ || is_blocked(costmap, follow);
}

bool Navigator::is_blocked(const Costmap& costmap, const FollowReport& follow) const {
  const bool is_news = follow.task == task_->id;
  if (is_news && follow.state == Following::kBlocked) return true;
  return planner_.first_blocked_leg(costmap, is_news ? follow.route_map : task_->route_map).has_value();
}

void Navigator::plan(Time now, const Pose2& map_T_robot, const Costmap& costmap, const FollowReport& follow) {
  planned_at_ = now;
  Plan plan =
      planner_.plan(costmap, {map_T_robot.translation(), to_->point_map, Unknown::kForbidden, in_vain_});
  was_free_ = was_free_ || plan.outcome == PlanOutcome::kFound;
  const bool is_shut = plan.outcome == PlanOutcome::kNoRoute;
  if (!is_shut) aside_map_.reset();
  if (is_shut) plan = approach(std::move(plan), map_T_robot.translation(), costmap);
  const bool approaches = is_shut && plan.outcome != PlanOutcome::kNoRoute;
  const bool is_another = approaches != std::exchange(approaches_, approaches);
  if (plan.outcome == PlanOutcome::kNoRoute) {
    task_.reset();
  } else if (!task_ || is_another || is_better(plan, costmap, follow)) {
    had_route_ = had_route_ || !approaches;
    task_ =
        DriveTask{errands_, plan.route_map, approaches ? std::nullopt : to_->yaw_rad, kNoLimit_mps, stops_};
  } else {
    return;  // the plan that is being driven stays the last one
  }
  last_plan_ = std::move(plan);
}

/// Whether it goes to the place nearest to where there is no route to, though one could stand there, as far
/// as is known; once.
bool Navigator::is_worth_a_look(const Plan& plan, const Vector2& robot_map) const {
  if (!stops_ || looked_ || !plan.nearest_map || !(plan.is_cut_off || was_free_)) return false;
  if (more_looks_ > 0 && !plan.door_map) return false;
  if (approaches_) return true;
  if (plan.door_map) return !plan.sees_door || (*plan.door_map - robot_map).norm() > kBesideDoor_m;
  return (*plan.nearest_map - robot_map).norm() >= kWorthLooking_m;
}

/// Where to in place of the destination.
Plan Navigator::approach(Plan plan, const Vector2& robot_map, const Costmap& costmap) {
  if (!aside_map_ && !is_worth_a_look(plan, robot_map)) return plan;
  Plan nearer = planner_.plan(costmap, {robot_map, aside_map_ ? *aside_map_ : *plan.nearest_map});
  if (nearer.outcome == PlanOutcome::kNoRoute) return plan;
  nearer.outcome = PlanOutcome::kNearby;
  nearer.reason = plan.reason;
  nearer.nearest_map = plan.nearest_map;
  return nearer;
}

bool Navigator::is_better(const Plan& plan, const Costmap& costmap, const FollowReport& follow) const {
  if (follow.task != task_->id || is_blocked(costmap, follow)) return true;
  if (plan.outcome == PlanOutcome::kFound && last_plan_->outcome == PlanOutcome::kNearby) return true;
  return plan.length_m < kBetter * follow.remaining_m;
}

/// Whether what holds it up may go away still.
bool Navigator::is_patient(Time now, double most_s) {
  if (!held_up_since_ || now < *held_up_since_) held_up_since_ = now;
  const double patience_s =
      std::min({patience_s_, most_s, had_route_ || gave_way_ ? patience_s_ : kFirstPatience_s});
  return now - *held_up_since_ <= from_seconds(patience_s);
}

/// In a pocket whose only way out somebody stands in, it goes to the far end: he may be waiting for it. And
/// it does not stay in a doorway, where a door could neither open nor close.
bool Navigator::gives_way(Time now, const Pose2& map_T_robot, const Costmap& costmap,
                          const FollowReport& follow) {
  if (!stops_ || gave_way_ || !last_plan_->door_map || planned_at_ != now) return false;
  if (!held_up_since_ || now - *held_up_since_ < kMakesRoom) return false;
  const Vector2 robot_map = map_T_robot.translation(), door_map = *last_plan_->door_map;
  const double from_door_m = (robot_map - door_map).norm();
  const RouteLengths& lengths = planner_.reach(costmap, robot_map, kPocket_m);
  if (!lengths.is_whole() && (came_up_ || from_door_m > kDoorway_m)) return false;
  gave_way_ = true;
  aside_map_ = lengths.is_whole() ? lengths.farthest_reached(door_map) : last_plan_->nearest_map;
  if (!aside_map_ || (*aside_map_ - door_map).norm() < from_door_m + kRoom_m) {
    aside_map_.reset();
    return false;
  }
  return sets_out_anew(now, map_T_robot, costmap, follow);
}

/// Close to the door that it waits before, once; not in a pocket whose way out it sees to be taken.
bool Navigator::may_come_up(const Vector2& robot_map, const Costmap& costmap) const {
  if (!stops_ || came_up_ || !last_plan_->door_map) return false;
  const double from_door_m = (*last_plan_->door_map - robot_map).norm();
  if (from_door_m < kRoom_m || from_door_m > kBesideDoor_m) return false;
  return !last_plan_->sees_door || !planner_.reach(costmap, robot_map, kPocket_m).is_whole();
}

/// From a little before it a door that stands open is not always seen to be: its leaf may hide the doorway.
bool Navigator::comes_up(Time now, const Pose2& map_T_robot, const Costmap& costmap,
                         const FollowReport& follow) {
  came_up_ = true;
  aside_map_ = last_plan_->door_map;
  return sets_out_anew(now, map_T_robot, costmap, follow);
}

/// Where one door stayed shut it looks at another; and at one that shut behind its back it looks first.
bool Navigator::looks_elsewhere(Time now, const Pose2& map_T_robot, const Costmap& costmap,
                                const FollowReport& follow) {
  if (!stops_ || !last_plan_->door_map || more_looks_ >= kMoreLooks) return false;
  const std::optional<Plan> before = last_plan_;
  aside_map_.reset();
  ++more_looks_;
  const bool is_there = (*before->door_map - map_T_robot.translation()).norm() < kBesideDoor_m;
  if (is_there) in_vain_.push_back(*before->door_map);
  looked_ = came_up_ = false;
  const bool has_task = sets_out_anew(now, map_T_robot, costmap, follow);
  if (!has_task) last_plan_ = before;  // it shows the door that it stands before
  return has_task;
}

bool Navigator::sets_out_anew(Time now, const Pose2& map_T_robot, const Costmap& costmap,
                              const FollowReport& follow) {
  plan(now, map_T_robot, costmap, follow);
  if (!task_) aside_map_.reset();
  if (task_) held_up_since_.reset();
  return task_.has_value();
}

Navigator::Report Navigator::end(State state, const std::string& reason) {
  Report report{state, reason, last_plan_ ? last_plan_->nearest_map : std::nullopt};
  give_up();
  return report;
}

}  // namespace dynslam
