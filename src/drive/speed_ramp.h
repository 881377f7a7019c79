// SPDX-License-Identifier: MIT
#pragma once

#include "base/time.h"
#include "base/twist.h"
#include "drive/kinematics.h"

namespace dynslam {

/// Acceleration limits: what a driver asks for is reached gradually. Speeding up from rest keeps the arc that
/// is asked for; slowing down never waits for it; the other way is through standing still. What has to be
/// fast is not done by asking: set() takes effect at once.
class SpeedRamp {
 public:
  explicit SpeedRamp(const KinematicsConfig& config = {}) : config_(config) {}

  /// The twist after `passed` on the way to `target`; negative time is none, and a long one counts as 0.1 s.
  /// REQUIRES: finite.
  Twist toward(const Twist& target, Duration passed) const;
  /// What the robot does now.
  void set(const Twist& twist) { now_ = twist; }
  const Twist& now() const { return now_; }

 private:
  KinematicsConfig config_;
  Twist now_;
};

}  // namespace dynslam
