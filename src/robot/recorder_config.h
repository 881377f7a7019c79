// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [recorder] of the configuration.
struct RecorderConfig {
  std::string folder = "recordings";
  bool always = false;
  int ring_mib = 1024;
  int file_mib = 64;
  int most_mib = 4096;
  int free_floor_mib = 200;
  bool camera = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"folder", "where recordings are kept"}, self.folder);
    visit(Field{"always", "whether all is recorded, the newest over the oldest"}, self.always);
    visit(Field{"ring_mib", "how much is kept of what is always recorded", 8, 1000000}, self.ring_mib);
    visit(Field{"file_mib", "how large a file of it becomes before the next one begins; ten minutes at most",
                1, 4000},
          self.file_mib);
    visit(Field{"most_mib", "how large a recording that was asked for can become", 1, 1000000},
          self.most_mib);
    visit(Field{"free_floor_mib", "how much of the disk recordings leave free", 0, 1000000},
          self.free_floor_mib);
    visit(Field{"camera", "whether the camera's pictures are recorded; it runs all the time then"},
          self.camera);
  }
};

}  // namespace dynslam
