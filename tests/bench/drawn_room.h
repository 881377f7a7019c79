// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "io/recording.h"

namespace dynslam::bench {

/// A made recording, for want of a real one with so many beams: a lidar of 1200 beams and an IMU go around a
/// furnished room of 12 x 9 m once, 0.05 m a scan. Walls and boxes are straight lines; ranges carry seeded
/// noise of 1 cm + 0.5 %. Every scan is taken in an instant. The same records every time.
std::unique_ptr<Recording> open_drawn_room();

}  // namespace dynslam::bench
