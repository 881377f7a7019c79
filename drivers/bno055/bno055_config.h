// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [imu] of the configuration: where the BNO055 is, and how it is mounted.
struct Bno055Config {
  std::string bus = "/dev/i2c-3";
  int address = 0x28;
  std::string forward = "x";
  std::string up = "z";
  bool use_compass = false;
  bool external_crystal = false;
  double rate_hz = 0.0;
  double latency_s = 0.005;

  bool has_imu() const { return bus != "none"; }

  /// What is wrong with the values together, if anything.
  std::optional<std::string> problem() const {
    if (axis_of(forward) == 0 || axis_of(up) == 0 || axis_of(forward) == axis_of(up))
      return R"(imu.forward, imu.up: must be two of the chip's axes at right angles, such as "x" and "-z")";
    return std::nullopt;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"bus", "the I2C bus that the BNO055 is wired to, best one of its own; none: there is no IMU"},
          self.bus);
    visit(Field{"address", "of the chip on it: 40, or 41 with its ADR pin high", 0x28, 0x29}, self.address);
    visit(Field{"forward", "which axis of the chip points to the robot's front: x, -x, y, ..."},
          self.forward);
    visit(Field{"up", "which axis of the chip points up"}, self.up);
    visit(Field{"use_compass", "heading by the compass, which motors and steel bend"}, self.use_compass);
    visit(Field{"external_crystal", "the board has a 32 kHz crystal for the chip"}, self.external_crystal);
    visit(Field{"rate_hz", "readings a second; 0: 100, or 50 on a bus by software", 0.0, 100.0},
          self.rate_hz);
    visit(Field{"latency_s", "how old an orientation is when it is read", 0.0, 0.1}, self.latency_s);
  }

 private:
  /// Its letter, whatever its sign; 0: it is none.
  static char axis_of(const std::string& text) {
    const bool is_signed = text.size() == 2 && text[0] == '-';
    const char axis = text.size() == 1 || is_signed ? text.back() : '\0';
    return axis == 'x' || axis == 'y' || axis == 'z' ? axis : '\0';
  }
};

}  // namespace dynslam
