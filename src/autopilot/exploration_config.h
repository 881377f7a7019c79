// SPDX-License-Identifier: MIT
#pragma once

#include "base/config_field.h"

namespace dynslam {

/// Section [exploration] of the configuration: what counts as a frontier, and which one is gone to.
struct ExplorationConfig {
  double least_depth_m = 0.4;
  double deep_within_m = 0.2;
  double least_width_m = 0.1;
  double least_length_m = 0.4;
  double last_look_length_m = 0.3;
  double least_extent_m = 0.3;
  double most_extent_m = 3.0;
  double merge_within_m = 0.2;
  double stand_within_m = 0.8;
  double nook_m2 = 1.0;
  double nook_way_m = 6.0;
  double gain_weight = 1.0;
  double keep_m = 1.5;
  double steady_s = 2.5;
  double same_place_m = 0.5;
  double retry_after_s = 60.0;
  double retry_cost_m = 8.0;
  int most_tries = 3;
  double revisit_after_s = 1800.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"least_depth_m", "the unknown counts where a square of this side fits into it", 0.0, 1.0},
          self.least_depth_m);
    visit(Field{"deep_within_m", "and this far around such a square", 0.0, 0.4}, self.deep_within_m);
    visit(Field{"least_width_m", "the free counts where a square of this side fits into it", 0.0, 1.0},
          self.least_width_m);
    visit(Field{"least_length_m", "a frontier has cells for a line of this length", 0.0, 10.0},
          self.least_length_m);
    visit(
        Field{"last_look_length_m", "or of this length when all else is done; it is gone to once", 0.0, 10.0},
        self.last_look_length_m);
    visit(Field{"least_extent_m", "the diagonal of the rectangle around a frontier is at least this", 0.0,
                10.0},
          self.least_extent_m);
    visit(Field{"most_extent_m", "and at most this: longer ones are several", 0.5, 100.0},
          self.most_extent_m);
    visit(Field{"merge_within_m", "frontiers this near to each other are one", 0.0, 2.0},
          self.merge_within_m);
    visit(Field{"stand_within_m", "a frontier is seen from this far, where it cannot be approached more", 0.0,
                5.0},
          self.stand_within_m);
    visit(Field{"nook_m2",
                "where less than so much is left to be seen, or through less than 0.6 m, it is a nook", 0.0,
                100.0},
          self.nook_m2);
    visit(Field{"nook_way_m",
                "and not worth a longer way than this, nor is a last look; up to 8 m2, more is worth more in "
                "proportion",
                0.0, 1e6},
          self.nook_way_m);
    visit(Field{"gain_weight", "how many metres of way a metre of frontier is worth", 0.0, 100.0},
          self.gain_weight);
    visit(Field{"keep_m", "another frontier is chosen when it is better by this many metres of way", 0.0,
                100.0},
          self.keep_m);
    visit(Field{"steady_s", "a frontier counts when it was there for so long: some only flicker", 0.0, 60.0},
          self.steady_s);
    visit(Field{"same_place_m", "what was tried this near counts as tried", 0.05, 5.0}, self.same_place_m);
    visit(Field{"retry_after_s", "a place tried in vain is left alone for so long", 0.0, 86400.0},
          self.retry_after_s);
    visit(Field{"retry_cost_m", "and after that counts as so much farther away for each time", 0.0, 1000.0},
          self.retry_cost_m);
    visit(
        Field{"most_tries",
              "after so many it is given up; after one where it was looked at and less than 1 m of it stayed",
              1, 1000},
        self.most_tries);
    visit(Field{"revisit_after_s", "where the robot was so long ago, it goes again", 0.0, 1e6},
          self.revisit_after_s);
  }
};

}  // namespace dynslam
