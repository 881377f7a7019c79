// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>

namespace dynslam {

/// The robot's clock: monotonic, nanoseconds, epoch of its own. In a replay it is the recording's stamps.
/// It has no now(): below the runtime, time is an argument.
struct RobotClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<RobotClock>;
  static constexpr bool is_steady = true;
};

using Time = RobotClock::time_point;
using Duration = RobotClock::duration;

constexpr double to_seconds(Duration d) { return std::chrono::duration<double>(d).count(); }

/// Rounds to the nanosecond. The caller sees to it that |s| < 9e9 (see `is_representable_s`).
constexpr Duration from_seconds(double s) {
  return Duration(static_cast<std::int64_t>(s * 1e9 + (s < 0 ? -0.5 : 0.5)));
}

/// Whether a number of seconds from outside fits into a Time; false for NaN.
constexpr bool is_representable_s(double s) { return s > -4.0e9 && s < 4.0e9; }

constexpr double seconds_of(Time t) { return to_seconds(t.time_since_epoch()); }
constexpr Time time_at_s(double s) { return Time(from_seconds(s)); }

}  // namespace dynslam
