// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/imu_sample.h"
#include "device/device.h"

namespace dynslam {

/// An orientation sensor. Each sample is handed out once, oldest first; used by one thread.
class Imu : public Device {
 public:
  /// Waits for a sample, until the robot's clock says `until` at most; nothing when none came. Throws
  /// DeviceError.
  virtual std::optional<ImuSample> next(Time until) = 0;
};

}  // namespace dynslam
