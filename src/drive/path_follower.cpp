// SPDX-License-Identifier: MIT
#include "drive/path_follower.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace dynslam {
namespace {

// Smoothing of the pose.
constexpr double kNewPoseShare = 0.4;
constexpr double kJump_m = 0.15, kJump_rad = 0.2;  ///< the map was corrected: nothing to be smoothed
constexpr double kLongestGap_s = 0.5;
// Where along the route the robot may be, from where it was.
constexpr double kBackward_m = 0.3, kForward_m = 0.5;
constexpr double kStandsUnder_radps = 0.1;
constexpr Duration kRest = std::chrono::milliseconds(400);
/// Of what may be off at the goal; the rest is for the pose's noise.
constexpr double kPlaceShare = 0.9, kHeadingShare = 0.8;
/// At the goal it tries for so long to face where it should; a full turn takes five seconds at most.
constexpr Duration kTurnsAtGoal = std::chrono::seconds(7);
constexpr Duration kHeldLately = std::chrono::seconds(1);
constexpr double kMoved_m = 0.05, kMoved_rad = 0.09;
constexpr double kFeltNearby_m = 1.0;
constexpr std::size_t kMostFelt = 16;

Pose2 moved_by(const Twist& twist, double s) {
  const double half_turn = 0.5 * twist.w_radps * s;
  return {twist.v_mps * s * std::cos(half_turn), twist.v_mps * s * std::sin(half_turn), 2.0 * half_turn};
}

bool are_far(const Pose2& a, const Pose2& b, double m, double rad) {
  return (a.translation() - b.translation()).norm() > m || std::abs(turn(a.yaw, b.yaw)) > rad;
}

std::string problem_of(const DriveTask& task) {
  const bool finite = std::all_of(task.route_map.begin(), task.route_map.end(),
                                  [](const Vector2& p) { return p.allFinite(); });
  if (!finite) return "a point of the route is not a number";
  if (task.yaw_rad && !std::isfinite(*task.yaw_rad)) return "the heading at the goal is not a number";
  if (!(task.most_mps > 0.0)) return "the speed limit is not more than zero";
  return {};
}

}  // namespace

const char* to_string(Following state) {
  switch (state) {
    case Following::kIdle:
      return "idle";
    case Following::kDriving:
      return "driving";
    case Following::kTurning:
      return "turning";
    case Following::kWaiting:
      return "waiting";
    case Following::kBlocked:
      return "blocked";
    case Following::kStuck:
      return "stuck";
    case Following::kArrived:
      return "arrived";
  }
  return "";
}

PathFollower::PathFollower(const FollowerConfig& config, const BodyConfig& body,
                           const ClearanceConfig& clearance)
    : config_(config), body_(body), room_(clearance), clearance_(body, clearance) {}

void PathFollower::follow(const DriveTask& task) {
  const bool goes_on = task_ && task_->id == task.id;
  problem_ = problem_of(task);
  Route route = problem_.empty() ? Route(task.route_map) : Route();
  const bool same_goal = goes_on && !route.empty() && !route_.empty() &&
                         (route.end() - route_.end()).norm() <= config_.goal_m &&
                         task.yaw_rad == task_->yaw_rad;
  task_ = task;
  route_ = std::move(route);
  new_route_ = true;
  progress_m_ = 0.0;
  backed_m_ = backs_until_m_ = 0.0;
  stuck_ = false;
  if (now_) anchor_at_ = followed_at_ = *now_;
  if (!same_goal) {
    at_goal_since_.reset();
    arrived_.reset();
  }
  if (goes_on) return;
  misses_ = 0;
  turning_ = 0;
  hindered_at_.reset();
}

void PathFollower::halt() {
  task_.reset();
  route_ = {};
  problem_.clear();
  last_ = {};
  turning_ = 0;
  hindered_at_.reset();
}

std::vector<Vector2> PathFollower::remaining() const {
  std::vector<Vector2> left;
  if (!task_ || route_.empty() || !now_) return left;
  left.push_back(pose_.translation());
  for (const Route::Corner& corner : route_.corners(progress_m_, route_.length_m()))
    left.push_back(route_.at(corner.along_m));
  left.push_back(route_.end());
  return left;
}

FollowOutput PathFollower::rest(Following state, std::string reason) {
  last_ = {};
  return {{}, state, route_.empty() ? 0.0 : remaining_m(), std::move(reason)};
}

FollowOutput PathFollower::next(const FollowInputs& in, const RecentMotion& motion) {
  if (!is_finite(in.map_T_robot)) return rest(Following::kWaiting, "the pose is not a number");
  estimate(in);
  if (!task_) return rest(Following::kIdle, "no route");
  if (!problem_.empty()) return rest(Following::kBlocked, problem_);
  if (route_.empty()) return rest(Following::kIdle, "no route");
  find_progress();
  if (arrived_) return rest(Following::kArrived, *arrived_);
  if (stuck_) return rest(Following::kStuck, "told to move, but does not");
  if (touches_) return rest(Following::kWaiting, "it touches something");
  const Tick tick{in.now, in.measured, motion};
  FollowOutput out;
  if (auto at_goal = come_to_goal(tick))
    out = std::move(*at_goal);
  else
    out = drive(tick);
  return watch_motion(in, std::move(out));
}

/// Carries the last pose along as measured, and gives the new one a share: less noise, and no delay.
void PathFollower::estimate(const FollowInputs& in) {
  const double passed_s = now_ ? to_seconds(in.now - *now_) : -1.0;
  const Pose2 before = now_ ? pose_ : in.map_T_robot;
  pose_ = in.map_T_robot;
  if (passed_s < 0.0 || passed_s > kLongestGap_s) {
    hindered_at_.reset();
    anchor_ = pose_;
    anchor_at_ = in.now;
  } else if (is_finite(in.measured)) {
    const Pose2 expected = before * moved_by(in.measured, passed_s);
    if (!are_far(expected, in.map_T_robot, kJump_m, kJump_rad))
      pose_ = interpolate(expected, in.map_T_robot, kNewPoseShare);
  }
  moved_m_ = (pose_.translation() - before.translation()).norm();
  if (passed_s > 0.0 && passed_s <= kLongestGap_s) backed_m_ += std::max(0.0, -last_.v_mps) * passed_s;
  const bool moves = is_moving(last_) || std::abs(in.measured.w_radps) > kStandsUnder_radps;
  if (!moved_at_ || in.now < *moved_at_ || moves) moved_at_ = in.now;
  now_ = in.now;
}

/// On which side of it nobody knows. What was far behind is forgotten, lest the map has moved since.
void PathFollower::feel(bool touches) {
  const bool begins = touches && !touches_;
  touches_ = touches;
  const Vector2 here = pose_.translation();
  while (!felt_turns_.empty() && (felt_turns_.front().pose.translation() - here).norm() > kFeltNearby_m)
    felt_turns_.pop_front();
  if (!begins || last_.v_mps != 0.0 || last_.w_radps == 0.0) return;
  felt_turns_.push_back({pose_, last_.w_radps > 0.0 ? 1 : -1});
  if (felt_turns_.size() > kMostFelt) felt_turns_.pop_front();
}

/// Looks no further than it may have come, lest it takes a leg beyond a wall for the one it is on.
void PathFollower::find_progress() {
  const Vector2 p = pose_.translation();
  if (new_route_) {
    if (route_.length_m() == 0.0) route_ = Route({p, route_.end()});
    progress_m_ = route_.first_near(p).along_m;
  }
  new_route_ = false;
  progress_m_ =
      route_.nearest(p, progress_m_ - kBackward_m - moved_m_, progress_m_ + kForward_m + moved_m_).along_m;
}

/// What there is to do at the goal; nothing when it is still to be driven to.
std::optional<FollowOutput> PathFollower::come_to_goal(const Tick& tick) {
  const Vector2 goal = pose_.inverse() * route_.end();
  const double away_m = goal.norm();
  const double enough_m = !task_->stops_at_end ? config_.pass_m
                          : goal.x() > 0.0     ? 0.5 * config_.goal_m  // it still comes nearer
                                               : 0.8 * config_.goal_m;
  if (away_m <= enough_m && is_near_goal() && !at_goal_since_) at_goal_since_ = tick.now;
  if (!at_goal_since_) return std::nullopt;
  const bool coasts = task_->stops_at_end && !is_at_rest(tick.now);
  const Following coming = turning_ != 0 ? Following::kTurning : Following::kDriving;
  if (coasts && !is_moving(last_)) return rest(coming);  // where it comes to rest is a guess
  const bool faces = !task_->stops_at_end || faces_goal_heading(tick);
  if (!faces && tick.now - *at_goal_since_ < kTurnsAtGoal) {
    const double left = turn(pose_.yaw, *task_->yaw_rad);
    if (turning_ == 0) begin_turn(left);
    return turn_by(tick, left, false);  // it is where it is to be
  }
  if (coasts) return rest(coming);
  turning_ = 0;
  if (!task_->stops_at_end || away_m <= kPlaceShare * config_.goal_m) {
    arrived_ = faces ? "" : "there is no room to turn";
    return rest(Following::kArrived, *arrived_);
  }
  at_goal_since_.reset();  // it was turned off it
  ++misses_;
  return std::nullopt;
}

/// Now, or while it turns by the time that it comes to rest.
bool PathFollower::faces_goal_heading(const Tick& tick) const {
  if (!task_->yaw_rad) return true;
  const double left = turn(pose_.yaw, *task_->yaw_rad);
  if (!is_moving(last_)) return std::abs(left) <= kHeadingShare * config_.goal_rad;
  const double w = std::isfinite(tick.measured.w_radps) ? tick.measured.w_radps : 0.0;
  return std::abs(left - 0.5 * config_.reaction_s * w) <= 0.5 * config_.goal_rad;
}

/// For so long that the pose is that at which it came to rest.
bool PathFollower::is_at_rest(Time now) const { return moved_at_ && now - *moved_at_ > kRest; }

/// Wheels that slip, or are blocked by what the lidar does not see.
FollowOutput PathFollower::watch_motion(const FollowInputs& in, FollowOutput out) {
  const Time now = in.now;
  if (in.held && is_moving(out.twist)) held_at_ = now;
  if (!is_moving(out.twist) || are_far(anchor_, pose_, kMoved_m, kMoved_rad)) {
    anchor_ = pose_;
    anchor_at_ = now;
  }
  if (now - anchor_at_ <= from_seconds(config_.no_progress_s)) return out;
  // Another way may be free; asking for the same one again and again is none.
  if (held_at_ && now - *held_at_ < kHeldLately) return rest(Following::kBlocked, "something is too near");
  stuck_ = true;
  return rest(Following::kStuck, "told to move, but does not");
}

}  // namespace dynslam
