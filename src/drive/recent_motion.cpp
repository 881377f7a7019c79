// SPDX-License-Identifier: MIT
#include "drive/recent_motion.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr Duration kKept = std::chrono::seconds(1);
constexpr std::size_t kMostLegs = 200;
constexpr Duration kImuGap = std::chrono::milliseconds(100);

/// Along an arc.
Pose2 driven(const Twist& twist, double seconds) {
  const double half_turn = 0.5 * twist.w_radps * seconds;
  const double chord = std::abs(half_turn) < 1e-6 ? 1.0 : std::sin(half_turn) / half_turn;
  const double way = twist.v_mps * seconds * chord;
  return {way * std::cos(half_turn), way * std::sin(half_turn), 2.0 * half_turn};
}

double median(double a, double b, double c) { return std::max(std::min(a, b), std::min(std::max(a, b), c)); }

}  // namespace

/// The middle one of three: a single sample may be a spike.
std::optional<double> RecentMotion::measured_turn_radps(const std::optional<ImuSample>& imu) {
  if (!imu || !imu->world_q_robot.coeffs().allFinite()) return std::nullopt;
  if (imu_ && imu->stamp != imu_->stamp) {
    const Duration passed = imu->stamp - imu_->stamp;
    if (passed > Duration(0) && passed <= kImuGap) {
      const double turned = turn(yaw_of(imu_->world_q_robot), yaw_of(imu->world_q_robot));
      rates_radps_[rates_++ % rates_radps_.size()] = turned / to_seconds(passed);
    } else {
      rates_ = 0;
    }
  }
  imu_ = imu;
  if (rates_ < rates_radps_.size()) return std::nullopt;
  return median(rates_radps_[0], rates_radps_[1], rates_radps_[2]);
}

void RecentMotion::add(Time now, const Twist& commanded, const std::optional<ImuSample>& imu) {
  const bool runs_on = !legs_.empty() && now >= legs_.back().begin && now - legs_.back().begin < kKept;
  if (!runs_on) {
    legs_.clear();
    imu_.reset();
    rates_ = 0;
  }
  Twist twist = commanded;
  const bool fresh = imu && now >= imu->stamp && now - imu->stamp <= kImuGap;
  const auto turning = measured_turn_radps(imu);
  measured_ = fresh && turning;
  if (measured_) twist.w_radps = *turning;
  legs_.push_back({now, twist});
  while (legs_.size() > kMostLegs || now - legs_.front().begin > kKept) legs_.pop_front();
}

Pose2 RecentMotion::between(Time from, Time to) const {
  Pose2 moved;
  if (legs_.empty() || to <= from) return moved;
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    const Time begin = i == 0 ? from : std::max(from, legs_[i].begin);
    const Time end = i + 1 == legs_.size() ? to : std::min(to, legs_[i + 1].begin);
    if (end > begin) moved = moved * driven(legs_[i].twist, to_seconds(end - begin));
  }
  return moved;
}

}  // namespace dynslam
