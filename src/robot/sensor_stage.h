// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "device/device_error.h"
#include "pipe/clock.h"
#include "robot/device_health.h"
#include "robot/stop_signal.h"

namespace dynslam {

/// Reads one sensor and hands on what it says. A sensor that fails is asked again after a pause, for ever;
/// meanwhile its health says what is wrong. One thread.
template <class Sensor>
class SensorStage {
 public:
  using Sample = typename decltype(std::declval<Sensor&>().next({}))::value_type;
  using Take = std::function<void(Sample)>;

  /// The sensor, the clock and `health` must outlive it.
  SensorStage(Sensor& sensor, Take take, const Clock& clock, Latest<DeviceHealth>& health)
      : sensor_(sensor), take_(std::move(take)), clock_(clock), health_(&sensor, health) {}

  /// Waits a while for a sample. Returns whether there was one.
  bool turn(const StopSignal& stop) {
    const Time now = clock_.now();
    if (now < ask_again_) {
      stop.wait(clock_.steady(ask_again_));
      return false;
    }
    try {
      std::optional<Sample> sample = sensor_.next(now + kPatience);
      if (!sample) return false;
      health_.answered(sample->stamp);
      take_(std::move(*sample));
      return true;
    } catch (const DeviceError& e) {
      health_.failed(e.what());
      ask_again_ = clock_.now() + kPause;
      return false;
    }
  }

 private:
  static constexpr Duration kPatience = std::chrono::milliseconds(200);
  static constexpr Duration kPause = std::chrono::milliseconds(500);

  Sensor& sensor_;
  Take take_;
  const Clock& clock_;
  HealthKeeper health_;
  Time ask_again_;
};

}  // namespace dynslam
