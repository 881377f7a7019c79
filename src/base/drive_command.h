// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "base/time.h"
#include "base/twist.h"

namespace dynslam {

/// What a driver wants now; also the heartbeat that says that he is still there.
struct DriveCommand {
  std::uint64_t seq = 0;  ///< counted up by the sender
  Twist twist;
  Time heard;         ///< when it reached the robot, by the robot's clock
  bool gone = false;  ///< the sender has left: from now on it is as if nothing were heard
};

}  // namespace dynslam
