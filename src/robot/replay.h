// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/counters.h"
#include "grid/chunked_grid.h"
#include "io/recording.h"
#include "io/trajectory.h"
#include "slam/slam_config.h"

namespace dynslam {

/// What a recording gave, and what it cost.
struct ReplayResult {
  std::vector<StampedPose> trajectory;       ///< final, one pose a scan
  std::vector<StampedPose> trajectory_live;  ///< as known at the time
  GridSnapshot map;
  std::size_t map_bytes = 0;
  std::size_t local_maps = 0;
  std::size_t local_maps_active = 0;

  std::uint64_t inserted = 0;               ///< scans drawn into the map; the others only got a pose
  std::vector<float> scan_ms;               ///< of each scan, reading not included
  std::map<std::string, double> stages_ms;  ///< mean over all scans
  double wall_s = 0.0;
  double cpu_s = 0.0;
  Counters counters;  ///< weather on the way from the file to the map
};

/// Told now and then: share of the recording read (0 to 1) and scans so far.
using ReplayProgress = std::function<void(double share, std::uint64_t scans)>;

/// Takes a recording through SLAM, all in this thread, as fast as it goes.
ReplayResult replay(Recording& recording, const SlamConfig& config, const ReplayProgress& progress);

}  // namespace dynslam
