// SPDX-License-Identifier: MIT
#include "drive/imu_watch.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/angles.h"
#include "drive/stamped.h"
#include "drive/words.h"

namespace dynslam {
namespace {

/// How far from 1 the length of an orientation may be; rounding alone gives much less.
constexpr double kLengthTolerance = 0.1;
/// A tilted robot is upright again when it leans so much less than the limit.
constexpr double kHysteresis_rad = 0.05;

bool is_valid(const Eigen::Quaterniond& q) {
  return q.coeffs().allFinite() && std::abs(q.norm() - 1.0) <= kLengthTolerance;
}

/// Between the robot's z axis and the vertical.
double tilt_of(const Eigen::Quaterniond& q) {
  const double down_share = 2.0 * (q.x() * q.x() + q.y() * q.y()) / q.squaredNorm();
  return std::acos(std::clamp(1.0 - down_share, -1.0, 1.0));
}

}  // namespace

void ImuWatch::clock_went_back() {
  // What was there is missed until it speaks again; what was tilted stays tilted.
  if (heard_) heard_ = Time::min();
  newest_.reset();
  contrary_since_.reset();
  frozen_ = false;
}

bool ImuWatch::is_news(Time now, const ImuSample& imu) const {
  return is_valid(imu.world_q_robot) && imu.stamp <= now + kStampJitter &&
         (!newest_ || imu.stamp > newest_->stamp);
}

void ImuWatch::take(const ImuSample& imu) {
  if (!newest_ || newest_->world_q_robot.coeffs() != imu.world_q_robot.coeffs()) {
    same_since_ = imu.stamp;
    frozen_ = false;
  }
  newest_ = imu;
  heard_ = imu.stamp;
  tilt_rad_ = tilt_of(imu.world_q_robot);
  const bool leans = tilt_rad_ > tilt_limit_rad_ - (tilted_ ? kHysteresis_rad : 0.0);
  if (leans == tilted_) {
    contrary_since_.reset();
    return;
  }
  if (!contrary_since_) contrary_since_ = imu.stamp;
  if (imu.stamp - *contrary_since_ < tilt_time_) return;
  tilted_ = leans;
  contrary_since_.reset();
}

Finding ImuWatch::update(Time now, const std::optional<ImuSample>& imu, bool exists, bool moving) {
  if (imu && is_news(now, *imu)) take(*imu);
  if ((imu || exists) && !heard_) heard_ = now;
  if (!moving && !frozen_) same_since_ = now;
  if (newest_ && newest_->stamp - same_since_ > timeout_) frozen_ = true;
  Finding imu_row = lost(now);
  lost_ = imu_row.cause != Cause::kNone;
  if (!tilted_) return imu_row;
  return {Cause::kTilt, {Motion::kStop, "tilted by " + fixed_text(degrees(tilt_rad_), 0) + " degrees"}};
}

Finding ImuWatch::lost(Time now) {
  if (!heard_) return {};
  const std::string unwatched = ": slow, as tilt is not watched";
  if (frozen_) return {Cause::kImu, {Motion::kSlow, "IMU frozen" + unwatched}};
  if (*heard_ == Time::min() || now < *heard_ - kStampJitter)
    return {Cause::kImu, {Motion::kSlow, "IMU silent" + unwatched}};
  if (now - *heard_ <= timeout_) return {};
  const char* what = newest_ ? "IMU silent for " : "IMU gave nothing valid for ";
  return {Cause::kImu, {Motion::kSlow, what + seconds_text(now - *heard_) + unwatched}};
}

}  // namespace dynslam
