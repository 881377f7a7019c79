// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "device/device_error.h"
#include "robot/ports.h"
#include "robot/stop_signal.h"

namespace dynslam {

/// Reads one sensor and hands on what it says. A sensor that fails is asked again after a pause, for ever;
/// meanwhile its health says what is wrong. One thread.
template <class Sample>
class SensorStage {
 public:
  using Read = std::function<std::optional<Sample>(Time until)>;
  using Take = std::function<void(Sample)>;

  SensorStage(Read read, Take take, const Clock& clock, Latest<DeviceHealth>& health)
      : read_(std::move(read)), take_(std::move(take)), clock_(clock), shown_(health) {
    health_.present = true;
    shown_.put(health_);
  }

  /// Waits a while for a sample. Returns whether there was one.
  bool turn(const StopSignal& stop) {
    const Time now = clock_.now();
    if (now < ask_again_) {
      stop.wait(clock_.steady(ask_again_));
      return false;
    }
    try {
      std::optional<Sample> sample = read_(now + kPatience);
      if (!sample) return false;
      note(sample->stamp);
      take_(std::move(*sample));
      return true;
    } catch (const DeviceError& e) {
      ++health_.errors;
      health_.trouble = e.what();
      shown_.put(health_);
      ask_again_ = clock_.now() + kPause;
      return false;
    }
  }

 private:
  static constexpr Duration kPatience = std::chrono::milliseconds(200);
  static constexpr Duration kPause = std::chrono::milliseconds(500);
  static constexpr Duration kShownEvery = std::chrono::milliseconds(100);

  void note(Time stamp) {
    ++health_.samples;
    health_.last_sample = stamp;
    if (health_.trouble.empty() && stamp < shown_at_ + kShownEvery && stamp > shown_at_) return;
    health_.trouble.clear();
    shown_at_ = stamp;
    shown_.put(health_);
  }

  Read read_;
  Take take_;
  const Clock& clock_;
  Latest<DeviceHealth>& shown_;
  DeviceHealth health_;
  Time shown_at_, ask_again_;
};

}  // namespace dynslam
