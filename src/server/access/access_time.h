// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

#include "base/wall_time.h"

namespace dynslam {

/// Now, on the two clocks that access needs: waits must not jump when the clock is set, and what is kept
/// over a restart must mean something then.
struct AccessTime {
  std::chrono::steady_clock::time_point steady;
  WallTime wall;

  static AccessTime now() { return {std::chrono::steady_clock::now(), wall_now()}; }
};

}  // namespace dynslam
