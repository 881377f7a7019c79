// SPDX-License-Identifier: MIT
#pragma once

#include "base/pin_state.h"

namespace dynslam {

/// Buttons and switches. Used by one thread.
class Pins {
 public:
  virtual ~Pins() = default;
  /// Throws DeviceError.
  virtual PinState read() = 0;
};

}  // namespace dynslam
