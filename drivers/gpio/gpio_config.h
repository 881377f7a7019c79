// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/config_field.h"

namespace dynslam {

/// Section [gpio] of the configuration: what hangs on the pins. Lines are GPIO numbers, not those of the
/// header's pins; -1 or an empty list: there is no such thing. By default switches lie between line and
/// ground and are closed until pressed, so that a broken wire reads as pressed.
struct GpioConfig {
  std::string chip = "auto";
  int estop_line = -1;
  bool estop_active_low = false;
  std::vector<std::string> bumper_lines;
  bool bumper_active_low = false;
  double bumper_debounce_s = 0.005;
  std::string pull = "up";
  int light_line = -1;
  bool light_active_low = false;
  int lidar_motor_line = -1;
  bool lidar_motor_active_low = false;

  bool has_pins() const { return estop_line >= 0 || !bumper_lines.empty(); }

  /// Whether one of its lines is that one.
  bool uses(int line) const {
    return line >= 0 && (line == estop_line || line == light_line || line == lidar_motor_line ||
                         std::any_of(bumper_lines.begin(), bumper_lines.end(), [&](const std::string& text) {
                           return line_number(text) == static_cast<unsigned>(line);
                         }));
  }

  /// The number of a line that is given as text.
  static std::optional<unsigned> line_number(const std::string& text) {
    unsigned number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number > kMostLine) return std::nullopt;
    return number;
  }

  /// What is wrong with the values together, if anything.
  std::optional<std::string> problem() const {
    if (pull != "up" && pull != "down" && pull != "none") return "gpio.pull: not 'up', 'down' or 'none'";
    std::set<unsigned> used;
    for (const int line : {estop_line, light_line, lidar_motor_line}) {
      if (line >= 0 && !used.insert(static_cast<unsigned>(line)).second) return used_twice(line);
    }
    if (bumper_lines.size() > kMostBumpers) return "gpio.bumper_lines: more than 16";
    for (const std::string& text : bumper_lines) {
      const auto line = line_number(text);
      if (!line) return "gpio.bumper_lines: '" + text + "' is no number from 0 to 511";
      if (!used.insert(*line).second) return used_twice(static_cast<int>(*line));
    }
    return std::nullopt;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"chip", "the chip of the lines: its name or label; auto: that of a Raspberry Pi's header"},
          self.chip);
    visit(Field{"estop_line", "line of the e-stop's button, -1: none", -1, kMostLine}, self.estop_line);
    visit(Field{"estop_active_low", "the e-stop is pressed while its line is low"}, self.estop_active_low);
    visit(Field{"bumper_lines", R"(lines of the bumpers, as in ["22", "27"])"}, self.bumper_lines);
    visit(Field{"bumper_active_low", "a bumper is pressed while its line is low"}, self.bumper_active_low);
    visit(Field{"bumper_debounce_s", "what presses a bumper for less is no touch", 0.0, 0.1},
          self.bumper_debounce_s);
    visit(Field{"pull", "what holds e-stop and bumpers while a wire is open: up, down or none"}, self.pull);
    visit(Field{"light_line", "line of the status light, -1: none", -1, kMostLine}, self.light_line);
    visit(Field{"light_active_low", "the light is on while its line is low"}, self.light_active_low);
    visit(Field{"lidar_motor_line", "line that lets the lidar spin, -1: none", -1, kMostLine},
          self.lidar_motor_line);
    visit(Field{"lidar_motor_active_low", "it spins while its line is low"}, self.lidar_motor_active_low);
  }

 private:
  static constexpr unsigned kMostLine = 511;
  static constexpr std::size_t kMostBumpers = 16;

  static std::string used_twice(int line) { return "gpio: line " + std::to_string(line) + " is used twice"; }
};

}  // namespace dynslam
