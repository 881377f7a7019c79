// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "grid/chunked_grid.h"
#include "io/recording.h"
#include "io/trajectory.h"
#include "robot/mapping_result.h"
#include "slam/slam_config.h"

namespace dynslam {

/// Told now and then: share of the recording read (0 to 1) and scans so far.
using ReplayProgress = std::function<void(double share, std::uint64_t scans)>;

/// The map as it grows: called after every so many scans.
struct ReplayFrames {
  std::uint64_t every = 0;  ///< scans; 0: never
  std::function<void(std::uint64_t scans, const GridSnapshot& map, const std::vector<StampedPose>& path)>
      show;
};

/// Takes a recording through SLAM, all in this thread, as fast as it goes.
MappingResult replay(Recording& recording, const SlamConfig& config, const ReplayProgress& progress,
                     const ReplayFrames& frames = {});

}  // namespace dynslam
