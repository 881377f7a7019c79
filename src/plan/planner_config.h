// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [planner] of the configuration: which way is a good way.
struct PlannerConfig {
  double margin_m = 0.04;
  double prune_margin_m = 0.02;
  double comfort_m = 0.45;
  double comfort_weight = 2.0;
  double post_weight = 4.0;
  double goal_tolerance_m = 0.3;
  double unknown_weight = 3.0;
  int most_expansions = 2000000;

  /// What is wrong with the values together, if anything.
  std::optional<std::string> problem() const {
    if (prune_margin_m > margin_m) return "planner.prune_margin_m: more than planner.margin_m";
    return std::nullopt;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"margin_m", "room beyond the robot's radius that a way is planned with", 0.0, 0.5},
          self.margin_m);
    visit(Field{"prune_margin_m", "room that is enough where a way is made shorter", 0.0, 0.5},
          self.prune_margin_m);
    visit(Field{"comfort_m", "nearer to things than this a way costs more", 0.0, 1.0}, self.comfort_m);
    visit(Field{"comfort_weight", "namely up to so many times its length more", 0.0, 10.0},
          self.comfort_weight);
    visit(Field{"post_weight", "beside a lone post, which may have a wide foot, so many times", 1.0, 10.0},
          self.post_weight);
    visit(Field{"goal_tolerance_m", "a goal that is too tight gives way to a point so near to it", 0.0, 2.0},
          self.goal_tolerance_m);
    visit(Field{"unknown_weight", "unknown ground costs so many times as much, where it may be crossed", 1.0,
                10.0},
          self.unknown_weight);
    visit(Field{"most_expansions", "coarse cells that are looked at for one way", 1000, 20000000},
          self.most_expansions);
  }
};

}  // namespace dynslam
