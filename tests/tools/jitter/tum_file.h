// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "io/byte_source.h"
#include "io/trajectory.h"

namespace dynslam::jitter {

/// Reads a trajectory of lines `t x y z qx qy qz qw` (seconds, metres; `#` begins a comment), gzipped or not.
/// Taken as a motion in the plane: z, roll and pitch are left out. In the order of the file; stamps of today
/// are good to the microsecond. Throws InputError, with file and line, for what is no such trajectory or
/// holds no pose.
std::vector<StampedPose> read_tum(ByteSource& source);

}  // namespace dynslam::jitter
