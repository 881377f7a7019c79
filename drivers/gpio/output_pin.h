// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "drivers/gpio/gpio_config.h"
#include "drivers/gpio/lines.h"

namespace dynslam {

/// An output that switches something on and off: a light, a motor's enable line. It is off at first and when
/// this ends. What fails is opened anew at the next call. One thread.
class OutputPin {
 public:
  using OpenOutput = std::function<std::unique_ptr<OutputLine>(bool active)>;

  explicit OutputPin(OpenOutput open) : open_(std::move(open)) {}
  ~OutputPin();

  /// Throws DeviceError; the caller may ask again as often as it likes to.
  void set(bool on);

 private:
  OpenOutput open_;
  std::unique_ptr<OutputLine> line_;
  bool on_ = false;
};

/// Null when the configuration names no line for it.
std::unique_ptr<OutputPin> make_status_light_pin(const GpioConfig& config);
std::unique_ptr<OutputPin> make_lidar_motor_pin(const GpioConfig& config);

}  // namespace dynslam
