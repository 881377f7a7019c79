// SPDX-License-Identifier: MIT
#include "drivers/driven_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dynslam::test {

DrivenWorld::DrivenWorld(World world, const Clock& clock, std::uint64_t seed)
    : world_(std::move(world)),
      clock_(clock),
      life_(world_, clock.now(), seed),
      lidar_(life_.now(), seed),
      poses_(kPosesKept, life_.body().pose()) {
  imu_.world_q_robot = life_.body().pose().world_q_robot();
}

template <class Ask>
auto DrivenWorld::at_now(Ask&& ask) {
  const std::lock_guard lock(mutex_);
  for (const Time now = clock_.now(); life_.now() + Life::kStep <= now;) {
    life_.step();
    poses_[++steps_ % poses_.size()] = life_.body().pose();
    while (const auto sample = life_.imu.take(life_.now())) imu_ = *sample;
  }
  return ask();
}

void DrivenWorld::drive(const WheelPower& power) {
  at_now([&] { life_.command(power, clock_.now()); });
}

BodyPose DrivenWorld::pose_at(Time when) const {
  const double ago = std::clamp(to_seconds(life_.now() - when) / to_seconds(Life::kStep), 0.0,
                                static_cast<double>(std::min(steps_, poses_.size() - 1)));
  const auto later = static_cast<std::size_t>(ago);
  const std::size_t earlier = std::min(later + 1, std::min(steps_, poses_.size() - 1));
  const auto pose = [&](std::size_t steps_ago) { return poses_[(steps_ - steps_ago) % poses_.size()]; };
  return interpolate(pose(later), pose(earlier), ago - std::floor(ago));
}

double DrivenWorld::range_m(double angle_rad, Time when) {
  return at_now([&] { return lidar_.range_m(pose_at(when), angle_rad, life_.caster()); });
}

TrueMotion DrivenWorld::motion() {
  return at_now([&] { return TrueMotion{imu_.world_q_robot, {0.0, 0.0, life_.body().twist().w_radps}}; });
}

double DrivenWorld::battery_v() {
  return at_now([&] { return life_.body().battery().voltage_v(); });
}

Twist DrivenWorld::twist() {
  return at_now([&] { return life_.body().twist(); });
}

Pose2 DrivenWorld::world_T_robot() {
  return at_now([&] { return life_.body().pose().world_T_robot; });
}

int DrivenWorld::contacts() {
  return at_now([&] { return life_.body().contacts(); });
}

bool DrivenWorld::touches() {
  return at_now([&] { return life_.body().touches(); });
}

std::vector<StampedPose> DrivenWorld::truth_map() {
  return at_now([&] {
    const Pose2 map_T_world = world_.world_T_start.inverse();
    std::vector<StampedPose> poses;
    for (const TruePose& p : life_.truth()) poses.push_back({p.stamp, map_T_world * p.world_T_robot});
    return poses;
  });
}

}  // namespace dynslam::test
