// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/motor_state.h"
#include "drive/finding.h"
#include "drive/safety_config.h"
#include "drive/stamped.h"

namespace dynslam {

/// Whether the motor board answers, guards itself by its failsafe, and reports no lasting fault. Its fault
/// bits may be set from power-up until both motors were driven once: until then they say nothing.
class MotorWatch {
 public:
  explicit MotorWatch(const SafetyConfig& config)
      : timeout_(from_seconds(config.motors_timeout_s)), fault_(from_seconds(config.motor_fault_s)) {}

  /// `motors` is the newest reading, `power` what the motors last got.
  Finding update(Time now, const std::optional<Stamped<MotorState>>& motors, const WheelPower& power);
  void clock_went_back();

 private:
  Finding faults();

  Duration timeout_, fault_;
  bool left_driven_ = false, right_driven_ = false;
  std::optional<Stamped<MotorState>> newest_;
  std::optional<Time> fault_since_;
};

}  // namespace dynslam
