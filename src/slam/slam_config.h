// SPDX-License-Identifier: MIT
#pragma once

#include "base/config_field.h"

namespace dynslam {

/// Section [slam] of the configuration.
struct SlamConfig {
  double cell_size_m = 0.02;
  double trusted_range_m = 12.0;
  double min_range_m = 0.15;
  double skip_yaw_rate_radps = 3.0;
  int scans_per_local_map = 50;
  double travel_per_local_map_m = 8.0;
  double search_half_width_m = 0.1;
  int max_chunks = 16384;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"cell_size_m", "side of a map cell", 0.005, 0.5}, self.cell_size_m);
    visit(Field{"trusted_range_m",
                "a ray is believed this far: beyond, neither hits nor free space are taken", 0.5, 100.0},
          self.trusted_range_m);
    visit(Field{"min_range_m", "nearer returns are the robot itself", 0.0, 5.0}, self.min_range_m);
    visit(Field{"skip_yaw_rate_radps", "scans taken while turning faster are matched but not drawn", 0.1,
                100.0},
          self.skip_yaw_rate_radps);
    visit(
        Field{"scans_per_local_map", "a local map is complete after so many scans taken in motion", 4, 10000},
        self.scans_per_local_map);
    visit(Field{"travel_per_local_map_m", "or after so much travel, whichever is first", 0.5, 1000.0},
          self.travel_per_local_map_m);
    visit(Field{"search_half_width_m", "least half width of the square in which a scan is searched for", 0.02,
                1.0},
          self.search_half_width_m);
    visit(Field{"max_chunks", "most chunks of 8 KiB a map may take (16384: 128 MiB, 26800 m2 at 2 cm)", 64,
                4194304},
          self.max_chunks);
  }
};

}  // namespace dynslam
