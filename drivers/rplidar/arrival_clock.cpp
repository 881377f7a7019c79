// SPDX-License-Identifier: MIT
#include "drivers/rplidar/arrival_clock.h"

#include <algorithm>

namespace dynslam::rplidar {
namespace {

/// Of how late a packet was read, so much is taken for the lidar's clock going slower than it says; but no
/// clock goes slower by a larger share of the step.
constexpr int kDriftShare = 64, kMostDrift = 128;
/// No reader sleeps that long: there was a break.
constexpr Duration kBreak = std::chrono::milliseconds(500);

}  // namespace

Time ArrivalClock::next(Time read_at, Duration step) {
  if (newest_) {
    const Duration late = read_at - (*newest_ + step);
    if (late > Duration::zero() && late < kBreak)
      return *(newest_ = *newest_ + step + std::min(late / kDriftShare, step / kMostDrift));
  }
  return *(newest_ = read_at);
}

}  // namespace dynslam::rplidar
