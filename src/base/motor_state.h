// SPDX-License-Identifier: MIT
#pragma once

namespace dynslam {

/// Shares of the full power of each side's motors, -1 to 1; forward is positive.
struct WheelPower {
  double left = 0.0;
  double right = 0.0;
  bool operator==(const WheelPower&) const = default;
};

/// What the motor board says of itself.
struct MotorState {
  double battery_v = 0.0;
  bool left_fault = false;
  bool right_fault = false;
  bool failsafe_on = false;  ///< the board stops the motors by itself when it hears nothing for 0.25 s
};

}  // namespace dynslam
