// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <deque>
#include <optional>

#include "base/imu_sample.h"
#include "base/pose2.h"
#include "base/twist.h"

namespace dynslam {

/// How the robot moved in the last second, as far as commands tell, and the IMU of its turns: enough to carry
/// a scan of a moment ago along.
class RecentMotion {
 public:
  /// From `now` on the robot is told to drive like this; `imu` is the newest sample, the same one again is
  /// fine. A `now` before the last one, or long after, forgets what was.
  void add(Time now, const Twist& commanded, const std::optional<ImuSample>& imu);

  /// How the robot moved from one time to another, as then_T_later. What was before the first command, and
  /// comes after the last one, is as these.
  Pose2 between(Time from, Time to) const;
  /// Whether turns are measured rather than commanded.
  bool knows_turns() const { return measured_; }

 private:
  struct Leg {
    Time begin;
    Twist twist;
  };
  std::optional<double> measured_turn_radps(const std::optional<ImuSample>& imu);

  std::deque<Leg> legs_;
  std::optional<ImuSample> imu_;
  std::array<double, 3> rates_radps_{};  ///< the newest ones, in a ring
  std::size_t rates_ = 0;                ///< how many there were
  bool measured_ = false;
};

}  // namespace dynslam
