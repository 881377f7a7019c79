// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/counters.h"
#include "grid/chunked_grid.h"
#include "io/graph_picture.h"
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
  std::uint64_t loop_closures = 0;
  GraphPicture graph;  ///< without the robot's path

  std::uint64_t inserted = 0;               ///< scans drawn into the map; the others only got a pose
  std::vector<float> scan_ms;               ///< of each scan, reading not included
  std::map<std::string, double> stages_ms;  ///< mean over all scans
  double wall_s = 0.0;
  double cpu_s = 0.0;
  std::vector<std::string> findings;  ///< what is wrong with the sensors' mounting
  Counters counters;                  ///< weather on the way from the file to the map
};

/// Told now and then: share of the recording read (0 to 1) and scans so far.
using ReplayProgress = std::function<void(double share, std::uint64_t scans)>;

/// The map as it grows: called after every so many scans.
struct ReplayFrames {
  std::uint64_t every = 0;  ///< scans; 0: never
  std::function<void(std::uint64_t scans, const GridSnapshot& map, const std::vector<StampedPose>& path)>
      show;
};

/// Takes a recording through SLAM, all in this thread, as fast as it goes.
ReplayResult replay(Recording& recording, const SlamConfig& config, const ReplayProgress& progress,
                    const ReplayFrames& frames = {});

}  // namespace dynslam
