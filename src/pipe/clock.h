// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>

#include "base/time.h"

namespace dynslam {

/// The robot's time. Any thread may ask.
class Clock {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;

  virtual ~Clock() = default;
  virtual Time now() const = 0;
  /// When it will be `t`, on the clock that threads can wait by.
  virtual SteadyTime steady(Time t) const = 0;
};

/// Life, or `speed` times as fast, from `begin` on.
class RunningClock : public Clock {
 public:
  explicit RunningClock(Time begin = Time(), double speed = 1.0)
      : begin_(begin), speed_(speed), steady_begin_(std::chrono::steady_clock::now()) {}

  Time now() const override {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - steady_begin_;
    return begin_ + from_seconds(passed.count() * speed_);
  }
  SteadyTime steady(Time t) const override {
    return steady_begin_ + from_seconds(to_seconds(t - begin_) / speed_);
  }

 private:
  Time begin_;
  double speed_;
  SteadyTime steady_begin_;
};

/// Stands still until it is set. Who waits by it does not wait.
class SteppedClock : public Clock {
 public:
  explicit SteppedClock(Time begin = Time()) : now_(begin) {}

  Time now() const override { return now_.load(); }
  SteadyTime steady(Time) const override { return {}; }  // long past
  /// REQUIRES: not before now().
  void set(Time t) { now_.store(t); }

 private:
  std::atomic<Time> now_;
};

}  // namespace dynslam
