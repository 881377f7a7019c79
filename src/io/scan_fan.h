// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "base/scan.h"

namespace dynslam {

/// A scan as sensor_msgs/LaserScan can say it: readings at equal steps of angle and time. Between the beams
/// of a lidar whose steps are not equal lie readings that are NaN: there was no beam.
struct ScanFan {
  Time stamp;  ///< of the first reading
  float first_rad = 0.0F;
  float step_rad = 0.0F;  ///< negative for a lidar that turns clockwise
  float time_step_s = 0.0F;
  std::vector<float> ranges_m;  ///< as Beam::range_m
};

/// Angles move by at most a quarter of a milliradian (3 mm at 12 m) or, should a sixteenth of the distance
/// between beams be more, by half of that. Of two beams that fall together the nearer is kept. Times are
/// those of a lidar that turns evenly. Beams whose angle or time is not finite, as no lidar gives them, are
/// left out.
ScanFan to_fan(const Scan& scan);

/// Takes out of a scan that was a ScanFan the readings between the beams. Where fewer than half of the
/// readings are NaN, they are invalid beams, and stay.
void drop_gaps(Scan& scan);

}  // namespace dynslam
