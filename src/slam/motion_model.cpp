// SPDX-License-Identifier: MIT
#include "slam/motion_model.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

// How wrong each source may be, from what indoor robots of this size do. Speeds change by accelerating: what
// the last velocity says is off by half of it times time squared.
constexpr double kAcceleration_mps2 = 1.0;
constexpr double kTurnAcceleration_radps2 = 6.0;
constexpr double kLongestCarryOn_s = 1.0;

/// Faster than any indoor robot: such a step of the wheels' count is a fault of the count.
constexpr double kFastest_mps = 5.0;
constexpr double kLongestWay_s = 20.0;

/// A leap of the wheels: more than this, and more than so strong an acceleration explains.
constexpr double kLeastLeap_m = 0.1;
constexpr double kLeapAcceleration_mps2 = 5.0;
constexpr double kLeastLeap_rad = 0.3;

constexpr double kLongestStandstill_s = 1.5;
constexpr std::size_t kMostFixes = 64;

// A wider search than this costs more than it finds.
constexpr double kLeastKnown_m = 0.6;
constexpr double kLeastKnown_rad = 0.35;

}  // namespace

std::optional<double> MotionModel::imu_turn(Time from, Time to) const {
  if (!imu_trusted_) return std::nullopt;
  const auto a = imu_.heading_at(from), b = imu_.heading_at(to);
  if (!a || !b) return std::nullopt;
  return *b - *a;
}

std::optional<Pose2> MotionModel::wheel_motion(Time from, Time to) const {
  if (!wheels_trusted_) return std::nullopt;
  const auto a = odometry_.pose_at(from), b = odometry_.pose_at(to);
  if (!a || !b) return std::nullopt;
  const Pose2 step = a->inverse() * *b;
  const double most_m = 0.5 + kFastest_mps * std::clamp(to_seconds(to - from), 0.0, kLongestWay_s);
  if (!(step.translation().norm() <= most_m)) return std::nullopt;  // nor what is not a number
  return step;
}

/// Along an arc at the last velocity, no longer than it can be trusted.
Pose2 MotionModel::carried_on(double seconds) const {
  const double t = std::clamp(seconds, -kLongestCarryOn_s, kLongestCarryOn_s);
  const double turned = velocity_.yaw_radps * t;
  const Pose2 half_turn{0, 0, 0.5 * turned};
  const Vector2 moved = half_turn * Vector2(velocity_.x_mps * t, velocity_.y_mps * t);
  return {moved.x(), moved.y(), turned};
}

MatchPrior MotionModel::by_wheels(const Pose2& from, const Pose2& step) {
  MatchPrior prior;
  const double travel = step.translation().norm(), turned = std::abs(step.yaw);
  prior.sigma_xy_m = 0.015 + 0.1 * travel + 0.03 * turned;
  prior.sigma_yaw_rad = 0.01 + 0.2 * turned + 0.05 * travel;
  prior.map_T_robot = from * step;
  return prior;
}

MatchPrior MotionModel::expect(Time t) const {
  const double dt = to_seconds(t - time_);
  Pose2 step = carried_on(dt);
  const double unsure_s =
      dt < 0 ? 1.0 : std::min(dt, 2.0);  // back in time: the clock was set, nothing is known
  MatchPrior prior;
  prior.sigma_xy_m = 0.02 + 0.5 * kAcceleration_mps2 * unsure_s * unsure_s;
  prior.sigma_yaw_rad = 0.005 + 0.5 * kTurnAcceleration_radps2 * unsure_s * unsure_s;
  if (const auto wheels = wheel_motion(time_, t)) {
    step = *wheels;
    prior = by_wheels(pose_, step);
  }
  if (const auto turned = imu_turn(time_, t)) {
    step.yaw = *turned;
    prior.sigma_yaw_rad = 0.004 + 0.004 * std::abs(*turned);
  }
  prior.sigma_xy_m = std::min(prior.sigma_xy_m, kLeastKnown_m);
  prior.sigma_yaw_rad = std::min(prior.sigma_yaw_rad, kLeastKnown_rad);
  prior.map_T_robot = pose_ * step;
  return prior;
}

MatchPrior MotionModel::expect_doubting_wheels(Time t) const {
  const double dt = to_seconds(t - time_);
  Pose2 step = carried_on(dt);
  MatchPrior prior;
  prior.sigma_xy_m = 0.2;
  prior.sigma_yaw_rad = 0.25;
  if (const auto wheels = dt > kLongestCarryOn_s ? wheel_motion(time_, t) : std::nullopt) {
    step = *wheels;
    const double travel = step.translation().norm();
    prior.sigma_xy_m = std::clamp(0.2 * travel, 0.1, kLeastKnown_m);
  }
  if (const auto turned = imu_turn(time_, t)) step.yaw = *turned;
  prior.map_T_robot = pose_ * step;
  return prior;
}

bool MotionModel::wheels_leap(Time t) const {
  const double dt = to_seconds(t - time_);
  const auto wheels = wheel_motion(time_, t);
  if (!wheels || dt <= 0 || dt > kLongestCarryOn_s) return false;
  const double beyond = (wheels->translation() - carried_on(dt).translation()).norm();
  return beyond > kLeastLeap_m + 0.5 * kLeapAcceleration_mps2 * dt * dt;
}

bool MotionModel::is_leap(Time t, const Pose2& map_T_robot) const {
  const double dt = to_seconds(t - time_);
  if (!has_fix_ || dt <= 0 || dt > kLongestCarryOn_s) return false;
  const auto is_far_from = [&](const Pose2& expected) {
    const Pose2 beyond = expected.inverse() * map_T_robot;
    return beyond.translation().norm() > kLeastLeap_m + kLeapAcceleration_mps2 * dt * dt ||
           std::abs(beyond.yaw) > kLeastLeap_rad + kTurnAcceleration_radps2 * dt * dt;
  };
  return is_far_from(pose_ * carried_on(dt)) && is_far_from(expect(t).map_T_robot);
}

std::optional<MatchPrior> MotionModel::expect_by_longer_way(Time t) const {
  if (fixes_.empty()) return std::nullopt;
  const auto wheels = wheel_motion(fixes_.front().time, t);
  if (!wheels) return std::nullopt;
  MatchPrior prior = by_wheels(fixes_.front().map_T_robot, *wheels);
  prior.sigma_xy_m = std::min(prior.sigma_xy_m, kLeastKnown_m);
  prior.sigma_yaw_rad = std::min(prior.sigma_yaw_rad, kLeastKnown_rad);
  if (const auto turned = imu_turn(time_, t)) prior.map_T_robot.yaw = pose_.yaw + *turned;
  return prior;
}

MotionInScan MotionModel::motion_around(Time reference) const {
  return [this, reference](Time t) {
    const double dt = to_seconds(t - reference);
    Pose2 moved = carried_on(dt);
    if (const auto turned = imu_turn(reference, t)) moved.yaw = *turned;
    return moved;
  };
}

TiltInScan MotionModel::tilt_around() const {
  return [this](Time t) { return imu_.tilt_at(t).value_or(Eigen::Quaterniond::Identity()); };
}

double MotionModel::yaw_rate(Time t) const {
  const Duration half = std::chrono::milliseconds(40);
  if (const auto turned = imu_turn(t - half, t + half)) return *turned / to_seconds(2 * half);
  return velocity_.yaw_radps;
}

void MotionModel::fix(Time t, const Pose2& map_T_robot, bool seen) {
  const double dt = to_seconds(t - time_);
  if (seen) last_seen_ = t;
  if (to_seconds(t - last_seen_) > kLongestCarryOn_s && !wheel_motion(time_, t)) {
    velocity_ = {};
  } else if (has_fix_ && dt > 0) {
    const Pose2 step = pose_.inverse() * map_T_robot;
    const Vector2 along = Pose2{0, 0, -0.5 * step.yaw} * step.translation();
    const double share = dt > 0.5 ? 1.0 : 0.7;  // of what one step shows, which is noisy when steps are short
    velocity_.x_mps += share * (along.x() / dt - velocity_.x_mps);
    velocity_.y_mps += share * (along.y() / dt - velocity_.y_mps);
    velocity_.yaw_radps = step.yaw / dt;
  }
  has_fix_ = true;
  time_ = t;
  pose_ = map_T_robot;
  remember(t, map_T_robot);
}

/// Keeps the fixes of the last while; a clock that is set back begins anew.
void MotionModel::remember(Time t, const Pose2& map_T_robot) {
  if (!fixes_.empty() && t <= fixes_.back().time) fixes_.clear();
  fixes_.push_back({t, map_T_robot});
  while (fixes_.size() > kMostFixes || to_seconds(t - fixes_.front().time) > kLongestStandstill_s)
    fixes_.pop_front();
}

}  // namespace dynslam
