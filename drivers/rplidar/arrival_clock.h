// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "base/time.h"

namespace dynslam::rplidar {

/// Tells from when packets were read when they must have come: they come at even steps by the lidar's own
/// clock, which goes a little faster or slower than it says, and are read some time later, never earlier. So
/// those that were read least late lie on a line, and all others above it: the line is found as the edge of
/// the lower hull over the middle of the last seconds (Zhang, Liu and Xia, 2002).
class ArrivalClock {
 public:
  /// Takes the next packet, which came `step` after the one before it. Returns its time, not after `read_at`.
  Time next(Time read_at, Duration step);
  /// Packets were lost.
  void forget() { windows_ = 0; }

 private:
  /// A packet: when it was sent by the lidar's clock, and how much later by ours it was read.
  struct Point {
    double sent_s = 0.0, late_s = 0.0;
  };
  static constexpr std::size_t kWindows = 32;

  double line_s(double sent_s) const { return late_s_ + drift_ * sent_s; }
  void begin(Time read_at);
  void begin_window(const Point& point);
  void fit_line();

  Time begin_;                              ///< what both clocks are counted from
  double sent_s_ = 0.0;                     ///< of the newest packet
  std::array<Point, kWindows> least_late_;  ///< of each of the last windows of time, around in a ring
  std::size_t windows_ = 0;                 ///< since it began; 0: it has not
  double window_ends_s_ = 0.0;
  double drift_ = 0.0;   ///< outlasts forget(): it is the lidar's
  double late_s_ = 0.0;  ///< of the line, where `sent_s` is 0
};

}  // namespace dynslam::rplidar
