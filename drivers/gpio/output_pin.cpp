// SPDX-License-Identifier: MIT
#include "drivers/gpio/output_pin.h"

#include <utility>

#include "drivers/gpio/chips.h"

namespace dynslam {
namespace {

std::unique_ptr<OutputPin> make_pin(const std::string& chip, int line, bool active_low,
                                    const std::string& who) {
  if (line < 0) return nullptr;
  const LineUse use{static_cast<unsigned>(line), active_low, Pull::kNone};
  return std::make_unique<OutputPin>(
      [chip, use, who](bool active) { return open_output(find_chip(chip, who), use, active, who); });
}

}  // namespace

OutputPin::~OutputPin() {
  if (!line_ || !on_) return;
  try {
    line_->set(false);
  } catch (const DeviceError&) {  // it is gone: nothing is left to switch off
  }
}

void OutputPin::set(bool on) {
  try {
    if (!line_) {
      line_ = open_(on);
    } else if (on != on_) {
      line_->set(on);
    }
    on_ = on;
  } catch (const DeviceError&) {
    line_.reset();
    throw;
  }
}

std::unique_ptr<OutputPin> make_status_light_pin(const GpioConfig& config) {
  return make_pin(config.chip, config.light_line, config.light_active_low, "status light");
}

std::unique_ptr<OutputPin> make_lidar_motor_pin(const GpioConfig& config) {
  return make_pin(config.chip, config.lidar_motor_line, config.lidar_motor_active_low, "lidar motor");
}

}  // namespace dynslam
