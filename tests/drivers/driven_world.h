// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <vector>

#include "drivers/bno055_emulator.h"
#include "io/trajectory.h"
#include "pipe/clock.h"
#include "sim/life.h"

namespace dynslam::test {

/// A world and a robot in it, in the time of a clock, for emulated devices: what they are told moves the
/// robot, and what they say is measured where it is. Whoever asks brings it up to the clock's now. Any
/// thread.
class DrivenWorld {
 public:
  /// `clock` must outlive it.
  DrivenWorld(World world, const Clock& clock, std::uint64_t seed = 1);

  const World& world() const { return world_; }

  void drive(const WheelPower& power);
  /// What a lidar in the robot's middle measures along an angle (counter-clockwise from ahead), at a time of
  /// the last two seconds; infinity: nothing.
  double range_m(double angle_rad, Time when);
  TrueMotion motion();
  double battery_v();

  Twist twist();
  Pose2 world_T_robot();
  int contacts();
  bool touches();
  /// Of the last five minutes at most, 100 poses a second, in the frame of the robot's start.
  std::vector<StampedPose> truth_map();

 private:
  template <class Ask>
  auto at_now(Ask&& ask);
  BodyPose pose_at(Time when) const;

  static constexpr std::size_t kPosesKept = 1024;

  const World world_;
  const Clock& clock_;
  std::mutex mutex_;  ///< guards all below
  Life life_;
  LidarModel lidar_;
  std::vector<BodyPose> poses_;  ///< after each of the last steps, around in a ring
  std::size_t steps_ = 0;
  ImuSample imu_;
};

}  // namespace dynslam::test
