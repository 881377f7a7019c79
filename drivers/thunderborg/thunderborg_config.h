// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [motors] of the configuration: where the motor board is and how the motors are wired to it.
struct ThunderBorgConfig {
  std::string bus = "/dev/i2c-1";
  int address = 0x15;
  bool swap = false;
  bool invert_a = false;
  bool invert_b = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"bus", "the I2C bus that the motor board is wired to"}, self.bus);
    visit(Field{"address", "of the board on it; 21 unless it was changed", 0x03, 0x77}, self.address);
    visit(Field{"swap", "output A drives the right side, not the left"}, self.swap);
    visit(Field{"invert_a", "output A turns its wheels backwards when told forwards"}, self.invert_a);
    visit(Field{"invert_b", "output B turns its wheels backwards when told forwards"}, self.invert_b);
  }
};

}  // namespace dynslam
