// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <vector>

#include "device/device_error.h"
#include "device/devices.h"
#include "pipe/clock.h"

namespace dynslam {

/// Remembers what it was told, and when.
class FakeMotors : public Motors {
 public:
  struct Call {
    Time at;
    WheelPower power;
  };
  explicit FakeMotors(const Clock& clock) : clock_(clock) {}

  void drive(const WheelPower& power) override {
    const std::lock_guard lock(mutex_);
    calls_.push_back({clock_.now(), power});
  }
  MotorState read() override { return {12.5, false, false, true}; }
  std::vector<Call> calls() const {
    const std::lock_guard lock(mutex_);
    return calls_;
  }

 private:
  const Clock& clock_;
  mutable std::mutex mutex_;
  std::vector<Call> calls_;
};

/// A wide empty room, ten times a second, after a real or a stepped clock.
class FakeLidar : public Lidar {
 public:
  explicit FakeLidar(const Clock& clock) : clock_(clock), due_(clock.now()) {}

  std::optional<Scan> next(Time until) override {
    std::unique_lock lock(mutex_);
    never_.wait_until(lock, clock_.steady(std::min(due_, until)), [] { return false; });
    if (clock_.now() < due_) return std::nullopt;
    Scan scan;
    scan.stamp = due_ - kTurn;
    // Real ranges are never the same twice: a scan that is counts as frozen.
    const float range = 5.0F + 0.001F * static_cast<float>(++scans_ % 7);
    for (int i = 0; i < 360; ++i) {
      const auto share = static_cast<float>(i) / 360.0F;
      scan.beams.push_back({static_cast<float>(2 * kPi) * (share - 0.5F), range, 0.1F * share});
    }
    due_ += kTurn;
    return scan;
  }

 private:
  static constexpr Duration kTurn = std::chrono::milliseconds(100);
  const Clock& clock_;
  Time due_;
  int scans_ = 0;
  std::mutex mutex_;
  std::condition_variable never_;
};

/// Does whatever the test wants it to.
class PuppetLidar : public Lidar {
 public:
  explicit PuppetLidar(std::function<std::optional<Scan>(Time)> next) : next_(std::move(next)) {}
  std::optional<Scan> next(Time until) override { return next_(until); }

 private:
  std::function<std::optional<Scan>(Time)> next_;
};

}  // namespace dynslam
