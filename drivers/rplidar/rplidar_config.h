// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [rplidar] of the configuration: how the lidar is reached, and what it is asked for.
struct RplidarConfig {
  std::string port = "auto";
  std::string port_folder = "/dev/serial/by-id";
  int baud = 0;
  std::string mode = "auto";
  double turns_per_s = 10.0;
  double delay_s = 0.001;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"port", "the serial port, or auto: the USB adapter of a lidar in port_folder"}, self.port);
    visit(Field{"port_folder", "where USB adapters are listed by name"}, self.port_folder);
    visit(Field{"baud", "bits a second on the line; 0: tries what such lidars use", 0, 4000000}, self.baud);
    visit(Field{"mode", "name of the scan mode, as probe lists them, or auto: the lidar's usual one"},
          self.mode);
    visit(Field{"turns_per_s", "how fast the lidar turns, where that can be set", 1.0, 20.0},
          self.turns_per_s);
    visit(Field{"delay_s", "how long the serial adapter keeps bytes before it hands them on", 0.0, 0.05},
          self.delay_s);
  }
};

}  // namespace dynslam
