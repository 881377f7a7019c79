// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/camera/camera_config.h"
#include "drivers/camera/yuv_picture.h"
#include "pipe/clock.h"

namespace dynslam {

/// A picture in the camera's own memory.
struct RawFrame {
  YuvView picture;
  Duration age;  ///< since its first row was exposed
};

/// A camera that runs from the moment it is made until it is destroyed, and keeps the newest picture only.
/// Used by one thread.
class FrameSource {
 public:
  using Take = std::function<void(const RawFrame&)>;

  virtual ~FrameSource() = default;
  /// Waits for a picture that was not handed out yet, until `until` at most, and hands it to `take`, good for
  /// the length of that call. Returns whether there was one. Throws DeviceError.
  virtual bool next(Clock::SteadyTime until, const Take& take) = 0;
};

/// What libcamera calls a camera.
struct CameraInfo {
  std::string id;     ///< long, and the same at each start
  std::string model;  ///< "imx219"
};

/// All cameras there are. Throws DeviceError when libcamera does not start.
std::vector<CameraInfo> list_cameras();

/// The camera of the configuration, over libcamera, running. Throws DeviceError.
std::unique_ptr<FrameSource> open_libcamera(const CameraConfig& config);

}  // namespace dynslam
