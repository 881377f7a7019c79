// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "drivers/camera/yuv_picture.h"

namespace dynslam {

/// Compresses pictures, some 60 kB each at 960x540. One thread.
class JpegEncoder {
 public:
  /// `quality` from 1 to 100. Throws DeviceError.
  explicit JpegEncoder(int quality);
  /// Throws DeviceError, for odd sizes too: the library would read beyond the planes.
  std::vector<std::uint8_t> encode(const YuvView& picture);

 private:
  std::unique_ptr<void, int (*)(void*)> encoder_;
  int quality_;
  std::vector<std::uint8_t> room_;
};

}  // namespace dynslam
