// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace dynslam {

/// Now, on the two clocks that access needs: waits must not jump when the clock is set, and what is kept
/// over a restart must mean something then.
struct AccessTime {
  std::chrono::steady_clock::time_point steady;
  std::chrono::sys_seconds wall;

  static AccessTime now() {
    return {std::chrono::steady_clock::now(),
            std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now())};
  }
};

}  // namespace dynslam
