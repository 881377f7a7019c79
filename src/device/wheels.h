// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/odometry.h"
#include "device/device.h"

namespace dynslam {

/// What counts how far the wheels roll. Each sample is handed out once, oldest first; used by one thread.
class Wheels : public Device {
 public:
  /// Waits for a sample, until the robot's clock says `until` at most; nothing when none came. Throws
  /// DeviceError.
  virtual std::optional<OdometrySample> next(Time until) = 0;
};

}  // namespace dynslam
