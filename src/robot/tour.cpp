// SPDX-License-Identifier: MIT
#include "robot/tour.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dynslam {
namespace {

/// Turned away from a point by more than this, the robot turns on the spot.
constexpr double kTurnFirst_rad = 0.5;
constexpr double kTurnGain = 2.0;      ///< rad/s for each radian off
constexpr double kSlowWithin_m = 0.6;  ///< of a point
constexpr double kLeast_mps = 0.12;
constexpr double kNearer_m = 0.05;

}  // namespace

Tour::Tour(std::vector<Vector2> points_map, const TourConfig& config)
    : points_(std::move(points_map)), config_(config) {}

Twist Tour::next(Time now, const PoseEstimate& pose, const Verdict& verdict) {
  if (done() || gave_up_) return {};
  // A driver whose command was cut off lets go before he pushes again.
  if (verdict.motion >= Motion::kStop) return wait(now, verdict.reason, 0.0);
  if (pose.lost) return wait(now, "lost", config_.look_round_radps);
  held_up_at_.reset();
  const double away_m = (target() - pose.map_T_robot.translation()).norm();
  if (away_m < config_.arrived_m) {
    if (backing_) {
      backing_ = false;
      nearer_at_.reset();
    } else {
      leave_point(true);
    }
    return done() ? Twist{} : next(now, pose, verdict);
  }
  if (!nearer_at_ || away_m < nearest_m_ - kNearer_m) {
    nearest_m_ = away_m;
    nearer_at_ = now;
  } else if (now - *nearer_at_ > from_seconds(config_.blocked_s)) {
    come_to_blocked_point();
    return {};
  }
  return towards(target(), pose.map_T_robot);
}

Vector2 Tour::target() const {
  if (!backing_) return points_[at_];
  return at_ == 0 ? Vector2(Vector2::Zero()) : points_[at_ - 1];
}

/// Whoever stands in the way may be gone when it comes again. Where there is no way back either, it goes on.
void Tour::come_to_blocked_point() {
  nearer_at_.reset();
  if (!backing_ && ++tries_ >= config_.tries) return leave_point(false);
  backing_ = !backing_;
}

/// Until it may go on, or its patience ends.
Twist Tour::wait(Time now, const std::string& trouble, double turn_radps) {
  nearer_at_.reset();  // the point is not to blame
  if (!held_up_at_) held_up_at_ = now;
  if (now - *held_up_at_ > from_seconds(config_.patience_s)) gave_up_ = trouble;
  return {0.0, gave_up_ ? 0.0 : turn_radps};
}

Twist Tour::towards(const Vector2& point, const Pose2& map_T_robot) const {
  const Vector2 ahead = map_T_robot.inverse() * point;
  const double off = std::atan2(ahead.y(), ahead.x());
  const double turn = std::clamp(kTurnGain * off, -config_.turn_radps, config_.turn_radps);
  if (std::abs(off) > kTurnFirst_rad) return {0.0, turn};
  const double share = std::min(1.0, ahead.norm() / kSlowWithin_m);
  return {std::max(kLeast_mps, config_.speed_mps * share * std::cos(off)), turn};
}

void Tour::leave_point(bool reached) {
  ++at_;
  ++(reached ? reached_ : skipped_);
  tries_ = 0;
  backing_ = false;
  nearer_at_.reset();
}

}  // namespace dynslam
