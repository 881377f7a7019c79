// SPDX-License-Identifier: MIT
#pragma once

#include "base/motor_state.h"
#include "base/verdict.h"
#include "device/device.h"

namespace dynslam {

/// The board that drives the wheels. It stops by itself 0.25 s after the last drive(). Both calls take about
/// a millisecond; used by one thread. Both throw DeviceError.
class Motors : public Device {
 public:
  /// Sets the power of both sides, to be repeated every tick. REQUIRES: finite; values beyond 1 are cut.
  virtual void drive(const WheelPower& power) = 0;
  virtual MotorState read() = 0;
  /// Shows people how far the robot may move, where the board has a light. Told every tick, seen some time
  /// after it; never throws.
  virtual void show(Motion) {}
};

}  // namespace dynslam
