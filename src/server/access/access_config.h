// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/config_field.h"

namespace dynslam {

/// Section [access] of the configuration.
struct AccessConfig {
  std::vector<std::string> allowed_hosts;
  std::vector<std::string> client_networks;
  int session_days = 90;
  int invitation_min = 15;
  bool simulation_pairs_itself = true;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"allowed_hosts",
                "further names that the robot is reached by, as \"robot.lan\"; its own and .local are known"},
          self.allowed_hosts);
    visit(Field{"client_networks",
                "further networks that clients may come from, as \"100.64.0.0/10\"; private ones are known, "
                "\"0.0.0.0/0\" and \"::/0\" let everybody ask"},
          self.client_networks);
    visit(Field{"session_days", "who was not seen for longer must pair anew", 1, 400}, self.session_days);
    visit(Field{"invitation_min", "how many minutes a code lasts that lets somebody in", 1, 1440},
          self.invitation_min);
    visit(
        Field{
            "simulation_pairs_itself",
            "with a simulated robot, whoever asks from this machine is an admin without pairing; false where "
            "a proxy on it lets others in"},
        self.simulation_pairs_itself);
  }

  /// What the limits of single fields cannot say, one line; nothing when all is well.
  std::optional<std::string> problem() const;
};

}  // namespace dynslam
