// SPDX-License-Identifier: MIT
#include "drive/path_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drive/words.h"

namespace dynslam {
namespace {

// Smoothing of the pose.
constexpr double kNewPoseShare = 0.4;
constexpr double kJump_m = 0.15, kJump_rad = 0.2;  ///< the map was corrected: nothing to be smoothed
constexpr double kLongestGap_s = 0.5;
// Where along the route the robot may be, from where it was.
constexpr double kBackward_m = 0.3, kForward_m = 0.5;
/// An arc that is nearly straight is: noise does not make the wheels tremble.
constexpr double kStraight_1pm = 0.1;
/// From a command until the wheels do it.
constexpr double kReaction_s = 0.25;
constexpr double kTurnBraking_radps2 = 3.0;
/// Slower turns do not overcome the skidding of the wheels.
constexpr double kLeastTurn_radps = 0.3;
/// On the spot, this near to the wanted direction is enough to drive on.
constexpr double kFaces_rad = 0.25;
/// Where no arc is free, this much off is turned on the spot.
constexpr double kTurnsOut_rad = 0.15;
/// The speed at which a way is asked for: how far one looks for what is in it.
constexpr double kLook_mps = 1.0;
constexpr double kNarrowShare = 0.4;  ///< of the speed is left where there is no room at all
constexpr double kMoved_m = 0.05, kMoved_rad = 0.09;
constexpr int kMostMisses = 4;
constexpr double kNearGoal_m = 0.3;

/// The speed that comes to rest within so many metres (or radians), braking that hard after the reaction.
double stopping_speed(double left, double braking) {
  return braking * (std::sqrt(kReaction_s * kReaction_s + 2.0 * std::max(0.0, left) / braking) - kReaction_s);
}

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
    : config_(config), body_(body), clearance_(body, clearance) {}

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
  stuck_ = false;
  if (now_) anchor_at_ = followed_at_ = *now_;
  if (!same_goal) at_goal_ = arrived_ = false;
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
  if (arrived_) return rest(Following::kArrived);
  if (stuck_) return rest(Following::kStuck, "told to move, but does not");
  const Tick tick{in.now, in.measured, motion};
  FollowOutput out;
  if (auto at_goal = come_to_goal(tick))
    out = std::move(*at_goal);
  else
    out = drive(tick);
  return watch_motion(in.now, std::move(out));
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
  now_ = in.now;
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
  const Vector2 goal = robot_T(route_.end());
  const double away_m = goal.norm();
  const auto arrive = [&] {
    arrived_ = true;
    return rest(Following::kArrived);
  };
  if (!task_->stops_at_end) {
    if (away_m <= config_.pass_m && remaining_m() <= 2.0 * config_.pass_m) return arrive();
    return std::nullopt;
  }
  const bool passed = goal.x() <= 0.0;
  const bool near = away_m <= 0.5 * config_.goal_m || (passed && away_m <= 0.8 * config_.goal_m);
  if (near && remaining_m() <= kNearGoal_m) at_goal_ = true;
  if (!at_goal_) return std::nullopt;
  if (task_->yaw_rad) {
    const double lead_s = std::isfinite(tick.measured.w_radps) ? 0.5 * kReaction_s : 0.0;
    const double left = turn(pose_.yaw, *task_->yaw_rad);
    const double will_be = left - (lead_s > 0.0 ? lead_s * tick.measured.w_radps : 0.0);
    if (std::abs(will_be) > 0.5 * config_.goal_rad) {
      if (turning_ == 0) turned_back_ = false;
      if (turning_ == 0 || (turning_ * left < 0.0 && std::abs(left) < 0.5 * kPi))
        turning_ = left < 0.0 ? -1 : 1;
      return turn_by(tick, left);
    }
  }
  turning_ = 0;
  if (away_m <= config_.goal_m) return arrive();
  at_goal_ = false;
  ++misses_;
  return std::nullopt;
}

FollowOutput PathFollower::drive(const Tick& tick) {
  const Vector2 p = pose_.translation();
  const double away_m = (route_.at(progress_m_) - p).norm();
  if (away_m > config_.off_route_m)
    return rest(Following::kBlocked, fixed_text(away_m, 1) + " m off the route");
  if (misses_ > kMostMisses) return rest(Following::kBlocked, "the goal cannot be reached exactly");

  const double farthest =
      std::clamp(config_.lookahead_s * last_.v_mps, config_.lookahead_least_m, config_.lookahead_most_m);
  const double sight =
      route_.sight_m(p, progress_m_, 0.5 * config_.lookahead_least_m, farthest, config_.cut_corner_m);
  const Vector2 to = robot_T(route_.at(progress_m_ + sight));
  const double off = std::atan2(to.y(), to.x());
  if (auto out = turn_first(tick, off)) return *out;

  // Nearer points would be overdone: the arc to them is as if they were at the least distance.
  const double reach = std::max(to.norm(), 0.5 * config_.lookahead_least_m);
  const double most = 0.95 * config_.turn_radps / config_.least_mps;
  double curvature = std::clamp(2.0 * to.y() / (reach * reach), -most, most);
  curvature = std::copysign(std::max(0.0, std::abs(curvature) - kStraight_1pm), curvature);
  const double last_curvature = last_.v_mps > 0.0 ? last_.w_radps / last_.v_mps : curvature;
  const ArcWish wish{curvature, last_curvature, most, speed_for(tick, curvature), to};
  const Duration patience = from_seconds(config_.blocked_s);
  const bool gave_up = hindered_at_ && tick.now - std::max(*hindered_at_, followed_at_) > patience;
  const double wanted_mps = allowed_mps(tick, curvature);
  std::optional<Arc> arc;
  if (wanted_mps > 0.0 && gave_up)
    arc = Arc{curvature, std::min(wish.speed_mps, wanted_mps)};
  else if (!gave_up)
    arc = choose_arc(wish, [&](double c) { return c == curvature ? wanted_mps : allowed_mps(tick, c); });
  if (!arc) {
    if (std::abs(off) > kTurnsOut_rad) {
      turning_ = off < 0.0 ? -1 : 1;
      turned_back_ = false;
      return turn_by(tick, off);
    }
    return hindered(tick.now,
                    clearance_.way(tick.now, {wish.speed_mps, wish.speed_mps * curvature}, tick.motion));
  }
  if (wanted_mps > 0.0 || (hindered_at_ && remaining_m() < hindered_remaining_m_ - kMoved_m)) {
    hindered_at_.reset();
  } else if (!hindered_at_) {
    hindered_at_ = tick.now;
    hindered_remaining_m_ = remaining_m();
  }
  last_ = {arc->speed_mps, arc->speed_mps * arc->curvature_1pm};
  return {last_, Following::kDriving, remaining_m(), {}};
}

/// Turning on the spot, when the route leads elsewhere than the robot faces.
std::optional<FollowOutput> PathFollower::turn_first(const Tick& tick, double off_rad) {
  if (turning_ == 0 && std::abs(off_rad) > config_.turn_first_rad) {
    turning_ = off_rad < 0.0 ? -1 : 1;
    turned_back_ = false;
    if (remaining_m() < kNearGoal_m) ++misses_;
  }
  if (turning_ == 0) return std::nullopt;
  const double w = std::isfinite(tick.measured.w_radps) ? tick.measured.w_radps : 0.0;
  if (std::abs(off_rad - kReaction_s * w) < kFaces_rad) {
    turning_ = 0;
    return std::nullopt;
  }
  if (turning_ * off_rad < 0.0 && std::abs(off_rad) < 0.5 * kPi) turning_ = -turning_;  // it went too far
  return turn_by(tick, off_rad);
}

/// In the direction of turning_, or when that is not free, in the other one.
FollowOutput PathFollower::turn_by(const Tick& tick, double left_rad) {
  ClearWay first;
  for (int attempt = 0; attempt < 2; ++attempt) {
    const double same_way = turning_ * left_rad;
    const double left = same_way < 0.0 ? same_way + kTwoPi : same_way;
    const double speed = std::clamp(stopping_speed(left, kTurnBraking_radps2),
                                    std::min(kLeastTurn_radps, config_.turn_radps), config_.turn_radps);
    const ClearWay way = clearance_.way(tick.now, {0.0, turning_ * speed}, tick.motion);
    if (way.share > 0.0) {
      last_ = {0.0, turning_ * way.share * speed};
      return {last_, Following::kTurning, remaining_m(), {}};
    }
    if (attempt == 0) first = way;
    if (turned_back_) break;
    turned_back_ = true;
    turning_ = -turning_;
  }
  return hindered(tick.now, first);
}

FollowOutput PathFollower::hindered(Time now, const ClearWay& way) {
  if (!hindered_at_) {
    hindered_at_ = now;
    hindered_remaining_m_ = remaining_m();
  }
  const bool for_good = now - *hindered_at_ > from_seconds(config_.blocked_s);
  return rest(for_good ? Following::kBlocked : Following::kWaiting,
              "something is in the way, " + fixed_text(way.distance_m, 2) + " m off");
}

/// Wheels that slip, or are blocked by what the lidar does not see.
FollowOutput PathFollower::watch_motion(Time now, FollowOutput out) {
  if (!is_moving(out.twist) || are_far(anchor_, pose_, kMoved_m, kMoved_rad)) {
    anchor_ = pose_;
    anchor_at_ = now;
  }
  if (now - anchor_at_ <= from_seconds(config_.no_progress_s)) return out;
  stuck_ = true;
  return rest(Following::kStuck, "told to move, but does not");
}

/// The slowest of what the limits, the arc, the next corner, the goal and things nearby call for.
double PathFollower::speed_for(const Tick& tick, double curvature_1pm) const {
  const double limit = std::min(config_.speed_mps, task_->most_mps);
  double speed = limit;
  if (curvature_1pm != 0.0) speed = std::min(speed, 0.95 * config_.turn_radps / std::abs(curvature_1pm));
  for (const Route::Corner& corner : route_.corners(progress_m_, progress_m_ + config_.lookahead_most_m)) {
    // The arc within the corner that passes it at the distance that may be cut, and where it begins.
    const double half = 0.5 * std::min(corner.turn_rad, 0.95 * kPi);
    const double radius = config_.cut_corner_m / std::max(1e-6, 1.0 / std::cos(half) - 1.0);
    const double round = std::max(config_.least_mps, 0.8 * config_.turn_radps * radius);
    const double before = corner.along_m - progress_m_ - std::min(radius * std::tan(half), kForward_m);
    speed = std::min(speed, round + stopping_speed(before, config_.braking_mps2));
  }
  if (task_->stops_at_end) speed = std::min(speed, stopping_speed(remaining_m(), config_.braking_mps2));
  const double room = std::min(1.0, clearance_.nearest_m(tick.now, tick.motion) / config_.narrow_m);
  speed = std::min(speed, limit * (kNarrowShare + (1.0 - kNarrowShare) * room));
  return std::max(speed, std::min(config_.least_mps, limit));
}

/// How fast the arc may be driven, as the scan has it; 0: not at all.
double PathFollower::allowed_mps(const Tick& tick, double curvature_1pm) const {
  const double ahead = kLook_mps / (1.0 + std::abs(curvature_1pm) * body_.radius_m());
  const double v = std::max(ahead, config_.speed_mps);
  return v * clearance_.way(tick.now, {v, v * curvature_1pm}, tick.motion).share;
}

}  // namespace dynslam
