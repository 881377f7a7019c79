// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/scan.h"
#include "device/device.h"

namespace dynslam {

/// A spinning lidar. Each scan is handed out once, oldest first; used by one thread.
class Lidar : public Device {
 public:
  /// Waits for a whole turn, until the robot's clock says `until` at most; nothing when none came. Throws
  /// DeviceError.
  virtual std::optional<Scan> next(Time until) = 0;
};

}  // namespace dynslam
