// SPDX-License-Identifier: MIT
#pragma once

#include "base/config_field.h"

namespace dynslam {

/// Section [safety] of the configuration.
struct SafetyConfig {
  double release_s = 0.05;
  double pins_timeout_s = 0.5;
  double motors_timeout_s = 0.5;
  double motor_fault_s = 0.2;
  double tilt_limit_rad = 0.44;
  double tilt_s = 0.1;
  double scan_timeout_s = 0.35;
  double imu_timeout_s = 0.5;
  double slow_mps = 0.3;
  double slow_turn_radps = 1.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"release_s", "the e-stop must be released for so long before it can be cleared", 0.0, 5.0},
          self.release_s);
    visit(Field{"pins_timeout_s", "stop when the e-stop was not read for longer", 0.05, 5.0},
          self.pins_timeout_s);
    visit(Field{"motors_timeout_s", "stop when the motor board was not read for longer", 0.05, 5.0},
          self.motors_timeout_s);
    visit(Field{"motor_fault_s", "stop when a motor's fault lasts longer", 0.0, 5.0}, self.motor_fault_s);
    visit(Field{"tilt_limit_rad", "stop when the robot leans more than this", 0.05, 1.5},
          self.tilt_limit_rad);
    visit(Field{"tilt_s", "for so long", 0.0, 5.0}, self.tilt_s);
    visit(Field{"scan_timeout_s", "stop when the newest beam of the lidar is older", 0.1, 5.0},
          self.scan_timeout_s);
    visit(Field{"imu_timeout_s", "slow down when an IMU that was there is silent or frozen for longer", 0.1,
                60.0},
          self.imu_timeout_s);
    visit(Field{"slow_mps", "the fastest when something calls for care", 0.02, 10.0}, self.slow_mps);
    visit(Field{"slow_turn_radps", "and the fastest turn", 0.1, 20.0}, self.slow_turn_radps);
  }
};

}  // namespace dynslam
