// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/jpeg_frame.h"
#include "device/device.h"

namespace dynslam {

/// A camera that looks ahead. Used by one thread, and only while somebody watches: between calls it may
/// sleep.
class Camera : public Device {
 public:
  /// Waits for the next picture, until the robot's clock says `until` at most; nothing when none came. Throws
  /// DeviceError.
  virtual std::optional<JpegFrame> next(Time until) = 0;
};

}  // namespace dynslam
