// SPDX-License-Identifier: MIT
#include "drivers/rplidar/arrival_clock.h"

namespace dynslam::rplidar {
namespace {

/// Of how late a packet was read, so much is taken for the lidar's clock going slower than it says.
constexpr int kDriftShare = 64;
/// No reader sleeps that long: there was a break.
constexpr Duration kBreak = std::chrono::milliseconds(100);

}  // namespace

Time ArrivalClock::next(Time read_at, Duration step) {
  if (newest_) {
    const Duration late = read_at - (*newest_ + step);
    if (late > Duration::zero() && late < kBreak) return *(newest_ = *newest_ + step + late / kDriftShare);
  }
  return *(newest_ = read_at);
}

}  // namespace dynslam::rplidar
