// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/time.h"

namespace dynslam::rplidar {

/// Tells from when packets were read when they must have come: they come at even steps, and are read some
/// time later, never earlier.
class ArrivalClock {
 public:
  /// Takes the next packet, which came `step` after the one before it. Returns its time, not after `read_at`.
  Time next(Time read_at, Duration step);
  /// Packets were lost.
  void forget() { newest_.reset(); }

 private:
  std::optional<Time> newest_;
};

}  // namespace dynslam::rplidar
