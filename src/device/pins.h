// SPDX-License-Identifier: MIT
#pragma once

#include "base/pin_state.h"
#include "device/device.h"

namespace dynslam {

/// Buttons and switches. Used by one thread.
class Pins : public Device {
 public:
  /// Throws DeviceError.
  virtual PinState read() = 0;
};

}  // namespace dynslam
