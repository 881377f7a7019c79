// SPDX-License-Identifier: MIT
#pragma once

#include "base/config_field.h"

namespace dynslam {

struct SlamConfig {
  double cell_size_m = 0.02;
  double trusted_range_m = 12.0;
  int scans_per_local_map = 50;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"cell_size_m", "edge length of a map cell", 0.005, 0.5}, self.cell_size_m);
    visit(Field{"trusted_range_m", "how far a ray's end is believed", 0.5, 200.0}, self.trusted_range_m);
    visit(Field{"scans_per_local_map", "inserted scans that complete a local map", 2, 10000},
          self.scans_per_local_map);
  }
};

}  // namespace dynslam
