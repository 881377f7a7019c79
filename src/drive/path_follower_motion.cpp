// SPDX-License-Identifier: MIT
// How it moves: along arcs, and on the spot.
#include <algorithm>
#include <cmath>

#include "drive/path_follower.h"
#include "drive/words.h"

namespace dynslam {
namespace {

/// Of the least lookahead: so near is what is steered to before a sharp corner.
constexpr double kSharpCornerShare = 0.5;
/// An arc that is nearly straight is: noise does not make the wheels tremble.
constexpr double kStraight_1pm = 0.1;
constexpr double kNewCurvatureShare = 0.5;  ///< the wheels could not follow jumps anyway
/// Tighter arcs are driven slower in proportion.
constexpr double kFullSpeedRadius_m = 0.6;
constexpr double kTurnShare = 0.95;   ///< of the fastest turn, for arcs
constexpr double kNarrowShare = 0.4;  ///< of the speed is left where there is no room at all
/// A corner is rounded from so far before it on, at most.
constexpr double kRounding_m = 0.5;
constexpr double kTurnBraking_radps2 = 3.0;
/// Slower turns do not overcome the skidding of the wheels.
constexpr double kLeastTurn_radps = 0.3;
/// A turn on the spot that is free only slower than this takes too long.
constexpr double kWorthTurning_radps = 0.12;
/// Straight back for a turn: so far at once, and in all.
constexpr double kBack_m = 0.06, kMostBack_m = 0.4;
/// So near to where it touched something in a turn it is the same turn, that ends so much before.
constexpr double kSameTurn_m = 0.08, kFeltMargin_rad = 0.15;
/// On the spot, this near to the wanted direction is enough to drive on.
constexpr double kFaces_rad = 0.25;
/// Where there is no room to turn on the spot, an arc leads on, up to this much off.
constexpr double kArcLeads_rad = 1.0;
/// Where no arc is free, this much off is turned on the spot.
constexpr double kTurnsOut_rad = 0.15;
/// The speed at which a way is asked for: how far one looks for what is in it.
constexpr double kLook_mps = 1.0;
/// By this nearer to the goal it got round what is in the way.
constexpr double kNearer_m = 0.05;
constexpr int kMostMisses = 4;

/// The speed that comes to rest within so many metres (or radians), braking that hard after the reaction.
double stopping_speed(double left, double braking, double reaction_s) {
  const double t = reaction_s;
  return braking * (std::sqrt(t * t + 2.0 * std::max(0.0, left) / braking) - t);
}

/// The rest of a turn when it goes to this side; 1: left.
double left_to(int side, double left_rad) {
  const double same_way = side * left_rad;
  return same_way < 0.0 ? same_way + kTwoPi : same_way;
}

}  // namespace

FollowOutput PathFollower::drive(const Tick& tick) {
  const double away_m = (route_.at(progress_m_) - pose_.translation()).norm();
  if (away_m > config_.off_route_m)
    return rest(Following::kBlocked, fixed_text(away_m, 1) + " m off the route");
  if (misses_ > kMostMisses) return rest(Following::kBlocked, "the goal cannot be reached exactly");
  const Vector2 to = aim_robot();
  const double off = std::atan2(to.y(), to.x());
  const bool turns = is_to_turn(tick, off);
  const bool has_room = turns && turn_to(tick, turning_, off).is_enough;
  if (turns && (has_room || std::abs(off) > kArcLeads_rad)) return turn_by(tick, off, true);

  const double wanted = curvature_to(to);
  const double wanted_mps = allowed_mps(tick, wanted);
  const std::optional<Arc> arc = arc_for(tick, to, wanted, wanted_mps);
  if (!arc && (turns || std::abs(off) > kTurnsOut_rad)) {
    if (!turns) begin_turn(off);
    return turn_by(tick, off, true);
  }
  turning_ = 0;
  if (!arc) return hindered(tick.now, clearance_.way(tick.now, {kLook_mps, kLook_mps * wanted}, tick.motion));
  note_hindrance(tick.now, wanted_mps > 0.0);
  last_ = {arc->speed_mps, arc->speed_mps * arc->curvature_1pm};
  return {last_, Following::kDriving, remaining_m(), {}};
}

/// The point of the route that is steered to, from the robot.
Vector2 PathFollower::aim_robot() const {
  const double least = config_.lookahead_least_m;
  const double most = std::clamp(config_.lookahead_s * last_.v_mps, least, config_.lookahead_most_m);
  const double sight =
      route_.sight_m(pose_.translation(), progress_m_, kSharpCornerShare * least, most, config_.cut_corner_m);
  return pose_.inverse() * route_.at(progress_m_ + sight);
}

/// The tightest arc that is fast enough to be driven.
double PathFollower::most_curvature_1pm() const {
  return kTurnShare * config_.turn_radps / config_.least_mps;
}

/// Of the arc that leads to a point; gentler to points that are nearly reached, and changed gradually.
double PathFollower::curvature_to(const Vector2& to_robot) const {
  const double reach = std::max(to_robot.norm(), kSharpCornerShare * config_.lookahead_least_m);
  const double most = most_curvature_1pm();
  const double exact = std::clamp(2.0 * to_robot.y() / (reach * reach), -most, most);
  const double calm = std::copysign(std::max(0.0, std::abs(exact) - kStraight_1pm), exact);
  if (last_.v_mps <= 0.0) return calm;
  const double last = last_.w_radps / last_.v_mps;
  return last + kNewCurvatureShare * (calm - last);
}

/// The wanted arc, or another one while there is hope that it leads round what is in the way.
std::optional<Arc> PathFollower::arc_for(const Tick& tick, const Vector2& to_robot, double wanted_1pm,
                                         double wanted_mps) const {
  const double speed = speed_for(tick, wanted_1pm);
  const Duration patience = from_seconds(config_.blocked_s);
  const bool gave_up = hindered_at_ && tick.now - std::max(*hindered_at_, followed_at_) > patience;
  if (gave_up && wanted_mps > 0.0) return Arc{wanted_1pm, std::min(speed, wanted_mps)};
  if (gave_up) return std::nullopt;
  const double last = last_.v_mps > 0.0 ? last_.w_radps / last_.v_mps : wanted_1pm;
  return choose_arc({wanted_1pm, last, most_curvature_1pm(), speed, to_robot}, [&](double curvature) {
    return curvature == wanted_1pm ? wanted_mps : allowed_mps(tick, curvature);
  });
}

/// Driving aside of what is in the way only counts when it leads on.
void PathFollower::note_hindrance(Time now, bool wanted_is_free) {
  const bool nearer = hindered_at_ && remaining_m() < hindered_remaining_m_ - kNearer_m;
  if (wanted_is_free || nearer) {
    hindered_at_.reset();
  } else if (!hindered_at_) {
    hindered_at_ = now;
    hindered_remaining_m_ = remaining_m();
  }
}

FollowOutput PathFollower::hindered(Time now, const ClearWay& way) {
  if (!hindered_at_) note_hindrance(now, false);
  const bool for_good = now - *hindered_at_ > from_seconds(config_.blocked_s);
  return rest(for_good ? Following::kBlocked : Following::kWaiting,
              "something is in the way, " + fixed_text(way.distance_m, 2) + " m off");
}

void PathFollower::begin_turn(double left_rad) {
  turning_ = left_rad < 0.0 ? -1 : 1;
  turned_back_ = false;
  backed_m_ = backs_until_m_ = 0.0;
}

/// Whether the route leads elsewhere than the robot faces, until it faces there.
bool PathFollower::is_to_turn(const Tick& tick, double off_rad) {
  if (turning_ == 0 && std::abs(off_rad) > config_.turn_first_rad) {
    begin_turn(off_rad);
    if (is_near_goal()) ++misses_;
  }
  const double w = std::isfinite(tick.measured.w_radps) ? tick.measured.w_radps : 0.0;
  if (std::abs(off_rad - config_.reaction_s * w) < kFaces_rad) turning_ = 0;
  return turning_ != 0;
}

/// Straight back, for the turn that it is at: it came from there.
std::optional<Twist> PathFollower::back_out(const Tick& tick) const {
  if (backed_m_ >= kMostBack_m) return std::nullopt;
  const Twist back{-std::min(config_.least_mps, task_->most_mps), 0.0};
  const ClearWay way = clearance_.way(tick.now, back, tick.motion);
  if (way.share <= 0.0) return std::nullopt;
  return Twist{way.share * back.v_mps, 0.0};
}

/// What it touched when it turned here before.
bool PathFollower::would_touch(int side, double left_rad) const {
  return std::any_of(felt_turns_.begin(), felt_turns_.end(), [&](const FeltTurn& felt) {
    if (felt.side != side || (felt.pose.translation() - pose_.translation()).norm() > kSameTurn_m)
      return false;
    double until_rad = side * turn(pose_.yaw, felt.pose.yaw);
    if (until_rad < -kFeltMargin_rad) until_rad += kTwoPi;
    return until_rad < left_to(side, left_rad) + kFeltMargin_rad;
  });
}

PathFollower::Turn PathFollower::turn_to(const Tick& tick, int side, double left_rad) const {
  if (would_touch(side, left_rad)) return {{}, {0.0, 0.0}, false};
  const double left = left_to(side, left_rad);
  const double least = std::min(kLeastTurn_radps, config_.turn_radps);
  const double speed =
      std::clamp(stopping_speed(left, kTurnBraking_radps2, config_.reaction_s), least, config_.turn_radps);
  const ClearWay way = clearance_.way(tick.now, {0.0, side * speed}, tick.motion);
  const Twist twist{0.0, side * way.share * speed};
  const bool goes_on =
      last_.w_radps * side > 0.0 && std::abs(twist.w_radps) >= std::min(speed, kWorthTurning_radps);
  if (goes_on) return {twist, way, true};
  // What it backs for is a good turn.
  const double margin_m = backed_m_ > 0.0 ? room_.side_margin_m : room_.creep_margin_m;
  const bool is_free =
      clearance_.free_m(tick.now, {0.0, side * speed}, tick.motion, margin_m) >= left * body_.radius_m();
  return {twist, way, is_free};
}

/// In the direction of turning_ when all of it is free; else a little back; else as far as it goes, this way
/// or the other.
FollowOutput PathFollower::turn_by(const Tick& tick, double left_rad, bool may_back) {
  const bool went_too_far = turning_ * left_rad < 0.0 && std::abs(left_rad) < 0.5 * kPi;
  if (went_too_far) turning_ = -turning_;
  if (would_touch(turning_, left_rad) && !would_touch(-turning_, left_rad)) turning_ = -turning_;
  const auto move = [&](const Twist& twist) {
    last_ = twist;
    return FollowOutput{twist, Following::kTurning, remaining_m(), {}};
  };
  const Turn turn = turn_to(tick, turning_, left_rad);
  const bool is_backing = backed_m_ < backs_until_m_;
  if (turn.is_enough && !is_backing) return move(turn.twist);
  if (const auto back = may_back ? back_out(tick) : std::nullopt) {
    if (!is_backing) backs_until_m_ = backed_m_ + kBack_m;
    return move(*back);
  }
  if (turn.way.share > 0.0) return move(turn.twist);
  if (turned_back_) return hindered(tick.now, turn.way);
  turned_back_ = true;
  turning_ = -turning_;
  const Turn other = turn_to(tick, turning_, left_rad);
  return other.way.share > 0.0 ? move(other.twist) : hindered(tick.now, turn.way);
}

/// The slowest of what the limits, the arc, the next corner, the goal and things nearby call for.
double PathFollower::speed_for(const Tick& tick, double curvature_1pm) const {
  const double limit = std::min(config_.speed_mps, task_->most_mps);
  double speed = std::min(limit, corner_speed_mps());
  if (curvature_1pm != 0.0) {
    const double radius = 1.0 / std::abs(curvature_1pm);
    speed = std::min({speed, kTurnShare * config_.turn_radps * radius, limit * radius / kFullSpeedRadius_m});
  }
  if (task_->stops_at_end)
    speed = std::min(speed, stopping_speed(remaining_m(), config_.braking_mps2, config_.reaction_s));
  const double room = std::min(1.0, clearance_.nearest_m(tick.now, tick.motion) / config_.narrow_m);
  speed = std::min(speed, limit * (kNarrowShare + (1.0 - kNarrowShare) * room));
  return std::max(speed, std::min(config_.least_mps, limit));
}

/// Such that each corner ahead is passed on the arc within it that cuts it by as much as may be cut.
double PathFollower::corner_speed_mps() const {
  double speed = config_.speed_mps;
  for (const Route::Corner& corner : route_.corners(progress_m_, progress_m_ + config_.lookahead_most_m)) {
    const double half = 0.5 * std::min(corner.turn_rad, 0.95 * kPi);
    const double radius = config_.cut_corner_m / std::max(1e-6, 1.0 / std::cos(half) - 1.0);
    const double round = std::max(config_.least_mps, 0.6 * config_.turn_radps * radius);
    const double before = corner.along_m - progress_m_ - std::min(radius * std::tan(half), kRounding_m);
    speed = std::min(speed, round + stopping_speed(before, config_.braking_mps2, config_.reaction_s));
  }
  return speed;
}

/// How fast the arc may be driven, as the scan has it; 0: not at all.
double PathFollower::allowed_mps(const Tick& tick, double curvature_1pm) const {
  const double ahead = kLook_mps / (1.0 + std::abs(curvature_1pm) * body_.radius_m());
  const double v = std::max(ahead, config_.speed_mps);
  return v * clearance_.way(tick.now, {v, v * curvature_1pm}, tick.motion).share;
}

}  // namespace dynslam
