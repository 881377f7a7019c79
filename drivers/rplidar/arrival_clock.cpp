// SPDX-License-Identifier: MIT
#include "drivers/rplidar/arrival_clock.h"

#include <algorithm>
#include <limits>

namespace dynslam::rplidar {
namespace {

constexpr double kWindow_s = 0.25;
/// Packets nearer to each other than this tell more of the reader than of the lidar's clock,
constexpr double kLeastSpan_s = 1.0;
/// which differs from ours by no larger share.
constexpr double kMostDrift = 1.0 / 128;
/// No reader sleeps that long: there was a break.
constexpr double kBreak_s = 0.5;

}  // namespace

Time ArrivalClock::next(Time read_at, Duration step) {
  sent_s_ += to_seconds(step);
  Point point{sent_s_, to_seconds(read_at - begin_) - sent_s_};
  if (windows_ == 0 || point.late_s > line_s(sent_s_) + kBreak_s) {
    begin(read_at);
    point = {};
  }
  if (sent_s_ >= window_ends_s_) begin_window(point);
  Point& least = least_late_[(windows_ - 1) % kWindows];
  if (point.late_s - drift_ * point.sent_s < least.late_s - drift_ * least.sent_s) least = point;
  late_s_ = std::min(late_s_, point.late_s - drift_ * point.sent_s);
  return std::min(read_at, begin_ + from_seconds(sent_s_ + line_s(sent_s_)));
}

void ArrivalClock::begin(Time read_at) {
  begin_ = read_at;
  sent_s_ = window_ends_s_ = late_s_ = 0.0;
  windows_ = 0;
}

void ArrivalClock::begin_window(const Point& point) {
  if (windows_ > 0) fit_line();
  least_late_[windows_++ % kWindows] = point;
  window_ends_s_ = point.sent_s + kWindow_s;
}

/// Of all edges from the older half to the newer one, the one that is lowest in the middle.
void ArrivalClock::fit_line() {
  const std::size_t n = std::min(windows_, kWindows);
  const auto at = [&](std::size_t i) { return least_late_[(windows_ - n + i) % kWindows]; };
  const double middle_s = 0.5 * (at(0).sent_s + at(n - 1).sent_s);
  double lowest_s = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = n - 1; k > i && at(i).sent_s <= middle_s && at(k).sent_s >= middle_s; --k) {
      const Point a = at(i), b = at(k);
      const double slope = (b.late_s - a.late_s) / (b.sent_s - a.sent_s);
      const double height_s = a.late_s + slope * (middle_s - a.sent_s);
      if (height_s >= lowest_s || b.sent_s - a.sent_s < kLeastSpan_s) continue;
      lowest_s = height_s;
      drift_ = std::clamp(slope, -kMostDrift, kMostDrift);
    }
  }
  late_s_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) late_s_ = std::min(late_s_, at(i).late_s - drift_ * at(i).sent_s);
}

}  // namespace dynslam::rplidar
