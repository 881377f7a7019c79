// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace dynslam {

/// Whoever started the program as a service and watches over it: systemd, told by sd_notify(3). Tells nobody
/// when there is nobody. One thread.
class Supervisor {
 public:
  Supervisor();
  /// Up and serving.
  void ready();
  /// The robot is alive, as its control thread shows; passed on no more often than it is wanted.
  void alive();
  void stopping();

 private:
  std::chrono::microseconds every_{0};  ///< 0: not wanted
  std::chrono::steady_clock::time_point told_;
};

}  // namespace dynslam
