// SPDX-License-Identifier: MIT
#include "robot/attitude_track.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace dynslam {
namespace {

constexpr Duration kSilent = std::chrono::seconds(1);
/// An angle is told in steps and with noise, which over less time would show as turning.
constexpr Duration kTurnOver = std::chrono::milliseconds(200);
constexpr double kUnitNorm = 0.05;

bool makes_sense(const ImuSample& sample) {
  return std::abs(sample.world_q_robot.norm() - 1.0) < kUnitNorm;  // nor does what is not a number
}

double roll_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.x() + q.y() * q.z()), 1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y()));
}

double pitch_of(const Eigen::Quaterniond& q) {
  return std::asin(std::clamp(2.0 * (q.w() * q.y() - q.z() * q.x()), -1.0, 1.0));
}

}  // namespace

std::optional<Attitude> AttitudeTrack::update(Time now, const std::optional<ImuSample>& newest) {
  if (newest && makes_sense(*newest)) take(*newest);
  if (!newest_ || now - newest_->stamp > kSilent) return std::nullopt;
  const Eigen::Quaterniond q = newest_->world_q_robot.normalized();
  return Attitude{roll_of(q), pitch_of(q), yaw_radps_};
}

void AttitudeTrack::take(const ImuSample& sample) {
  newest_ = sample;
  const Duration passed = before_ ? sample.stamp - before_->stamp : -kSilent;
  if (passed >= Duration::zero() && passed < kTurnOver) return;
  const bool follows = passed >= kTurnOver && passed <= kSilent;
  const double turned = follows ? turn(yaw_of(before_->world_q_robot), yaw_of(sample.world_q_robot)) : 0.0;
  yaw_radps_ = follows ? turned / to_seconds(passed) : 0.0;
  before_ = sample;
}

}  // namespace dynslam
