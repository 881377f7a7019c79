// SPDX-License-Identifier: MIT
#include "sim/imu_model.h"

namespace dynslam {
namespace {

constexpr double kHeadingNoise_rad = radians(0.08), kTiltNoise_rad = radians(0.12);
constexpr double kDrift_radps = radians(0.004);  // 14 degrees an hour
constexpr double kWalk_rad = radians(0.002);     // a sample
constexpr double kSpikes = 0.002;                // share of samples
constexpr double kMountedOff_rad = radians(0.4);

Eigen::Quaterniond turned(double roll, double pitch, double yaw) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
}

}  // namespace

ImuModel::ImuModel(Time begin, std::uint64_t seed)
    : random_(seed, 3),
      next_(begin + kPeriod),
      heading_off_rad_(random_.uniform(-kPi, kPi)),
      drift_radps_(kDrift_radps * random_.normal()) {
  const double roll = kMountedOff_rad * random_.normal(), pitch = kMountedOff_rad * random_.normal();
  robot_q_chip_ = turned(roll, pitch, 0.0);
}

void ImuModel::measure(Time now, const BodyPose& late, Outbox<ImuSample>& out) {
  heading_off_rad_ += drift_radps_ * to_seconds(kPeriod) + kWalk_rad * random_.normal();
  double heading = heading_off_rad_ + kHeadingNoise_rad * random_.normal();
  const double roll = kTiltNoise_rad * random_.normal(), pitch = kTiltNoise_rad * random_.normal();
  const double luck = random_.uniform(), side = random_.uniform() < 0.5 ? -1.0 : 1.0;
  const double spike = side * radians(random_.uniform(10.0, 60.0));
  if (luck < kSpikes) heading += spike;
  ImuSample sample;
  sample.stamp = now;
  sample.world_q_robot =
      (turned(0, 0, heading) * late.world_q_robot() * robot_q_chip_ * turned(roll, pitch, 0.0)).normalized();
  next_ = now + kPeriod;
  out.put(now + kDelivery, sample);
}

}  // namespace dynslam
