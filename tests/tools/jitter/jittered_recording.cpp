// SPDX-License-Identifier: MIT
#include "tools/jitter/jittered_recording.h"

#include <utility>

namespace dynslam::jitter {
namespace {

enum Stream : std::uint32_t { kDrops, kNoise, kOrigin, kHeading };

constexpr double kFarthestOrigin_m = 100.0;

}  // namespace

JitteredRecording::JitteredRecording(std::unique_ptr<Recording> recording, const JitterConfig& config,
                                     std::uint64_t seed)
    : recording_(std::move(recording)), config_(config), drops_(seed, kDrops), noise_(seed, kNoise) {
  PortableRandom origin(seed, kOrigin), heading(seed, kHeading);
  if (config_.move_odometry) {
    moved_T_odom_.x = origin.uniform(-kFarthestOrigin_m, kFarthestOrigin_m);
    moved_T_odom_.y = origin.uniform(-kFarthestOrigin_m, kFarthestOrigin_m);
    moved_T_odom_.yaw = origin.uniform(-kPi, kPi);
  }
  if (config_.turn_imu)
    turned_q_world_ = Eigen::AngleAxisd(heading.uniform(-kPi, kPi), Eigen::Vector3d::UnitZ());
}

std::optional<Record> JitteredRecording::next() {
  while (std::optional<Record> record = recording_->next()) {
    if (is_cut(*record)) continue;
    if (std::visit([this](auto& sample) { return keep(sample); }, *record)) return record;
  }
  return std::nullopt;
}

/// Once past the cut, always past it: a clock that is set back later cuts nothing more.
bool JitteredRecording::is_cut(const Record& record) {
  if (begun_) return false;
  const Time stamp = std::visit([](const auto& sample) { return sample.stamp; }, record);
  if (!first_scan_ && std::holds_alternative<Scan>(record)) first_scan_ = stamp;
  begun_ = config_.cut_s <= 0.0 || (first_scan_ && to_seconds(stamp - *first_scan_) >= config_.cut_s);
  return !begun_;
}

bool JitteredRecording::keep(const Scan& /*scan*/) { return drops_.uniform() >= config_.drop_share; }

bool JitteredRecording::keep(ImuSample& sample) const {
  if (config_.turn_imu) sample.world_q_robot = (turned_q_world_ * sample.world_q_robot).normalized();
  return true;
}

bool JitteredRecording::keep(OdometrySample& sample) {
  if (config_.odometry_noise > 0.0) sample.odom_T_robot = with_noise(sample.odom_T_robot);
  if (config_.move_odometry) sample.odom_T_robot = moved_T_odom_ * sample.odom_T_robot;
  return true;
}

/// Each step a little longer or shorter, put one after the other, as wheels would have counted it.
Pose2 JitteredRecording::with_noise(const Pose2& recorded) {
  if (last_recorded_) {
    const Pose2 step = last_recorded_->inverse() * recorded;
    const double way = 1.0 + config_.odometry_noise * noise_.gauss();
    const double turned = 1.0 + config_.odometry_noise * noise_.gauss();
    last_noisy_ = last_noisy_ * Pose2{way * step.x, way * step.y, turned * step.yaw};
  } else {
    last_noisy_ = recorded;
  }
  last_recorded_ = recorded;
  return last_noisy_;
}

}  // namespace dynslam::jitter
