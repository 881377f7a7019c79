// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/config_field.h"
#include "drivers/bno055/bno055_config.h"
#include "drivers/camera/camera_config.h"
#include "drivers/gpio/encoders_config.h"
#include "drivers/gpio/gpio_config.h"
#include "drivers/rplidar/rplidar_config.h"
#include "drivers/thunderborg/thunderborg_config.h"

namespace dynslam {

/// How a real robot's devices are reached.
struct HardwareConfig {
  RplidarConfig rplidar;
  Bno055Config imu;
  ThunderBorgConfig motors;
  CameraConfig camera;
  GpioConfig gpio;
  EncodersConfig encoders;

  /// What is wrong with one device's values beside another's, if anything.
  std::optional<std::string> problem() const {
    if (gpio.chip != encoders.chip) return std::nullopt;
    for (const int line :
         {encoders.left_a_line, encoders.left_b_line, encoders.right_a_line, encoders.right_b_line}) {
      if (gpio.uses(line)) return "encoders: line " + std::to_string(line) + " is one of gpio's too";
    }
    return std::nullopt;
  }

  template <class Self, class Visit>
  static void sections(Self& self, Visit&& visit) {
    visit(std::string_view("rplidar"), self.rplidar);
    visit(std::string_view("imu"), self.imu);
    visit(std::string_view("motors"), self.motors);
    visit(std::string_view("camera"), self.camera);
    visit(std::string_view("gpio"), self.gpio);
    visit(std::string_view("encoders"), self.encoders);
  }
};

/// Section [state] of the configuration.
struct StateConfig {
  std::string folder;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"folder", "where pairings, places and the IMU's calibration are kept; empty: nowhere"},
          self.folder);
  }
};

}  // namespace dynslam
