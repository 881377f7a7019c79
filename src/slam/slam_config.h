// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [slam] of the configuration.
struct SlamConfig {
  double cell_size_m = 0.02;
  double trusted_range_m = 12.0;
  double min_range_m = 0.15;
  double skip_yaw_rate_radps = 3.0;
  double skip_tilt_rate_radps = 1.0;
  int scans_per_local_map = 50;
  double travel_per_local_map_m = 8.0;
  double search_half_width_m = 0.1;
  bool close_loops = true;
  int correction_delay_scans = 5;
  int max_chunks = 16384;

  /// Cells along a trusted ray: what a scan costs grows with its square.
  static constexpr int kMostCells = 4000;

  static constexpr double kMostTrusted_m = 100.0;
  double most_trusted_range_m() const { return std::min(kMostTrusted_m, kMostCells * cell_size_m); }

  /// What is wrong with the values together, if anything.
  std::optional<std::string> problem() const {
    if (trusted_range_m > kMostCells * cell_size_m)
      return "slam.trusted_range_m: more than 4000 cells of slam.cell_size_m";
    if (min_range_m >= trusted_range_m) return "slam.min_range_m: not less than slam.trusted_range_m";
    return std::nullopt;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"cell_size_m", "side of a map cell", 0.005, 0.5}, self.cell_size_m);
    visit(
        Field{"trusted_range_m", "a ray is believed this far: beyond, neither hits nor free space are taken",
              0.5, kMostTrusted_m},
        self.trusted_range_m);
    visit(Field{"min_range_m", "nearer returns are the robot itself", 0.0, 5.0}, self.min_range_m);
    visit(Field{"skip_yaw_rate_radps", "scans taken while turning faster are matched but not drawn", 0.1,
                100.0},
          self.skip_yaw_rate_radps);
    visit(Field{"skip_tilt_rate_radps", "and so are those taken while the robot tips faster", 0.05, 100.0},
          self.skip_tilt_rate_radps);
    visit(
        Field{"scans_per_local_map", "a local map is complete after so many scans taken in motion", 4, 10000},
        self.scans_per_local_map);
    visit(Field{"travel_per_local_map_m", "or after so much travel, whichever is first", 0.5, 1000.0},
          self.travel_per_local_map_m);
    visit(Field{"search_half_width_m", "least half width of the square in which a scan is searched for", 0.02,
                1.0},
          self.search_half_width_m);
    visit(Field{"close_loops", "recognise places seen before and straighten the map; otherwise it drifts"},
          self.close_loops);
    visit(Field{"correction_delay_scans", "in a replay, a closed loop moves the pose so many scans later", 0,
                1000},
          self.correction_delay_scans);
    visit(Field{"max_chunks", "most chunks of 8 KiB a map may take (16384: 128 MiB, 26800 m2 at 2 cm)", 64,
                4194304},
          self.max_chunks);
  }
};

}  // namespace dynslam
