// SPDX-License-Identifier: MIT
#pragma once

#include "base/pose_estimate.h"
#include "grid/chunked_grid.h"

namespace dynslam {

/// What the robot knows of the building and its place in it, after a scan. Immutable; any thread may read it.
struct WorldState {
  PoseEstimate pose;  ///< at the scan's stamp
  GridSnapshot map;
};

}  // namespace dynslam
