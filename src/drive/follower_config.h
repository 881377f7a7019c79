// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [follower] of the configuration: how a route is driven.
struct FollowerConfig {
  double speed_mps = 0.5;
  double turn_radps = 1.5;
  double least_mps = 0.08;
  double braking_mps2 = 0.5;
  double reaction_s = 0.25;
  double lookahead_s = 1.2;
  double lookahead_least_m = 0.3;
  double lookahead_most_m = 0.8;
  double cut_corner_m = 0.05;
  double turn_first_rad = 1.571;
  double narrow_m = 0.2;
  double off_route_m = 1.0;
  double goal_m = 0.05;
  double goal_rad = 0.087;
  double pass_m = 0.25;
  double blocked_s = 2.0;
  double no_progress_s = 2.0;

  /// What is wrong with the values together, if anything.
  std::optional<std::string> problem() const {
    if (least_mps > speed_mps) return "follower.least_mps: more than follower.speed_mps";
    if (lookahead_least_m > lookahead_most_m)
      return "follower.lookahead_least_m: more than follower.lookahead_most_m";
    return std::nullopt;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"speed_mps", "speed on a straight with nothing near", 0.05, 5.0}, self.speed_mps);
    visit(Field{"turn_radps", "fastest turn", 0.3, 10.0}, self.turn_radps);
    visit(Field{"least_mps", "slowest speed that is asked for where nothing is in the way", 0.01, 1.0},
          self.least_mps);
    visit(Field{"braking_mps2", "how gently it slows down for corners and the goal", 0.05, 5.0},
          self.braking_mps2);
    visit(Field{"reaction_s", "from a command until the wheels do it", 0.0, 2.0}, self.reaction_s);
    visit(Field{"lookahead_s", "the point of the route that is steered to is so long ahead", 0.2, 5.0},
          self.lookahead_s);
    visit(Field{"lookahead_least_m", "but at least so far", 0.1, 3.0}, self.lookahead_least_m);
    visit(Field{"lookahead_most_m", "and at most so far", 0.1, 5.0}, self.lookahead_most_m);
    visit(Field{"cut_corner_m", "so far inside a corner of the route it may pass", 0.02, 1.0},
          self.cut_corner_m);
    visit(Field{"turn_first_rad", "facing away from the route by more, it turns on the spot", 0.5, 3.1},
          self.turn_first_rad);
    visit(Field{"narrow_m", "with less room than this around the body it drives slower", 0.01, 2.0},
          self.narrow_m);
    visit(Field{"off_route_m", "farther from the route than this it asks for another", 0.2, 10.0},
          self.off_route_m);
    visit(Field{"goal_m", "this near to the goal it is reached", 0.02, 1.0}, self.goal_m);
    visit(Field{"goal_rad", "and facing within this of the wanted heading", 0.02, 1.0}, self.goal_rad);
    visit(Field{"pass_m", "this near to a goal where it need not stop it is reached", 0.05, 3.0},
          self.pass_m);
    visit(Field{"blocked_s", "what is in the way for so long will not go away", 0.2, 60.0}, self.blocked_s);
    visit(Field{"no_progress_s", "told to move and not moving for so long, it is stuck", 0.5, 60.0},
          self.no_progress_s);
  }
};

}  // namespace dynslam
