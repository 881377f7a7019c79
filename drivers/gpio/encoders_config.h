// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [encoders] of the configuration: a quadrature encoder on a wheel of each side. Up to some 2000
/// edges a second in all; faster ones take the kernel's rotary-encoder or a microcontroller.
struct EncodersConfig {
  std::string chip = "auto";
  int left_a_line = -1, left_b_line = -1;
  int right_a_line = -1, right_b_line = -1;
  bool left_reversed = false, right_reversed = true;
  double metres_per_step = 0.0005;
  double track_m = 0.3;

  bool has_encoders() const {
    return left_a_line >= 0 && left_b_line >= 0 && right_a_line >= 0 && right_b_line >= 0;
  }

  /// What is wrong with the values together, if anything.
  std::optional<std::string> problem() const {
    const std::array<int, 4> lines = {left_a_line, left_b_line, right_a_line, right_b_line};
    const auto given = std::count_if(lines.begin(), lines.end(), [](int line) { return line >= 0; });
    if (given == 0) return std::nullopt;
    if (given < 4) return "encoders: all four lines must be given, or none";
    if (std::set<int>(lines.begin(), lines.end()).size() < 4) return "encoders: a line is used twice";
    return std::nullopt;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    constexpr double kMostLine = 511;
    visit(Field{"chip", "the chip of the lines, as gpio.chip"}, self.chip);
    visit(Field{"left_a_line", "channel A of the left wheel, -1: none", -1, kMostLine}, self.left_a_line);
    visit(Field{"left_b_line", "channel B of the left wheel, -1: none", -1, kMostLine}, self.left_b_line);
    visit(Field{"right_a_line", "channel A of the right wheel, -1: none", -1, kMostLine}, self.right_a_line);
    visit(Field{"right_b_line", "channel B of the right wheel, -1: none", -1, kMostLine}, self.right_b_line);
    visit(Field{"left_reversed", "B leads while the left wheel turns forward"}, self.left_reversed);
    visit(Field{"right_reversed", "B leads while the right wheel turns forward"}, self.right_reversed);
    visit(Field{"metres_per_step", "way of a wheel for each of the four steps of a period", 1e-6, 1.0},
          self.metres_per_step);
    visit(Field{"track_m", "between the sides' wheels, as it counts when turning", 0.05, 3.0}, self.track_m);
  }
};

}  // namespace dynslam
