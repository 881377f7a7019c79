// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/config_field.h"
#include "server/robot_name.h"

namespace dynslam {

/// Section [server] of the configuration.
struct ServerConfig {
  std::string name;
  int port = 8080;
  std::string bind;
  int seats = 64;
  int seats_kept = 8;
  int seats_per_address = 40;

  /// What the limits of single fields cannot say, one line; nothing when all is well.
  std::optional<std::string> problem() const {
    if (name.empty() || is_robot_name(name)) return std::nullopt;
    return std::string("server.name: ").append(kRobotNameRule);
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"name", "of the robot, for people; empty: that of this machine"}, self.name);
    visit(Field{"port", "where the page is served; 0: any port that is free", 0, 65535}, self.port);
    visit(Field{"bind", "the address of this machine to serve on; empty: all of them"}, self.bind);
    visit(Field{"seats", "connections that are served at the same time, each by a thread", 16, 512},
          self.seats);
    visit(Field{"seats_kept", "of these, kept for driving and STOP", 4, 12}, self.seats_kept);
    visit(Field{"seats_per_address", "connections that one address may have", 4, 512},
          self.seats_per_address);
  }
};

}  // namespace dynslam
