// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "base/time.h"

namespace dynslam {

/// A picture of the camera, compressed.
struct JpegFrame {
  Time stamp;  ///< when it was taken
  std::vector<std::uint8_t> bytes;
};

}  // namespace dynslam
