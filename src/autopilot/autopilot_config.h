// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [autopilot] of the configuration.
struct AutopilotConfig {
  std::string when_explored = "revisit";
  bool looks_round = true;
  double look_round_radps = 0.6;
  int most_touches = 3;
  double patience_s = 60.0;
  double door_patience_s = 120.0;
  double choose_every_s = 1.0;
  double patrol_pause_s = 3.0;

  /// What is wrong with the values, if anything.
  std::optional<std::string> problem() const {
    if (when_explored == "stay" || when_explored == "home" || when_explored == "revisit") return std::nullopt;
    return R"(autopilot.when_explored: must be "stay", "home" or "revisit")";
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"when_explored",
                R"(when all is mapped: "stay", go "home", or "revisit" what was not seen for long)"},
          self.when_explored);
    visit(Field{"looks_round", "whether a robot that is lost turns on the spot to find itself"},
          self.looks_round);
    visit(Field{"look_round_radps", "and how fast", 0.1, 3.0}, self.look_round_radps);
    visit(Field{"most_touches",
                "so often within a minute of one errand it backs off from what it touched, or what holds it "
                "while its wheels turn, and goes on; then, or with 0 at once, it stops and a person has "
                "to look",
                0, 100},
          self.most_touches);
    visit(Field{"patience_s", "lost or without a sensor for so long, it gives up", 1.0, 3600.0},
          self.patience_s);
    visit(Field{"door_patience_s",
                "so long, all in all, it drives to doors that shut off something to explore, and as long "
                "again it hopes that they open",
                0.0, 86400.0},
          self.door_patience_s);
    visit(Field{"choose_every_s", "so often it looks for a better place to explore", 0.1, 60.0},
          self.choose_every_s);
    visit(Field{"patrol_pause_s", "how long it stays at each stop of a patrol", 0.0, 3600.0},
          self.patrol_pause_s);
  }
};

}  // namespace dynslam
