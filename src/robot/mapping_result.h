// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/counters.h"
#include "grid/chunked_grid.h"
#include "io/graph_picture.h"
#include "io/trajectory.h"
#include "slam/slam.h"

namespace dynslam {

/// What a recording or a mission gave, and what it cost.
struct MappingResult {
  std::vector<StampedPose> trajectory;       ///< final, one pose a scan
  std::vector<StampedPose> trajectory_live;  ///< as known at the time
  GridSnapshot map;
  std::size_t map_bytes = 0;
  std::size_t local_maps = 0;
  std::size_t local_maps_active = 0;
  std::uint64_t loop_closures = 0;
  std::vector<Vector2> route_map, places_map;  ///< that the autopilot had at the end
  GraphPicture graph;                          ///< without the robot's path

  std::uint64_t inserted = 0;               ///< scans drawn into the map; the others only got a pose
  std::vector<float> scan_ms;               ///< of each scan, reading not included
  std::map<std::string, double> stages_ms;  ///< mean over all scans
  double wall_s = 0.0;
  double cpu_s = 0.0;
  std::vector<std::string> findings;  ///< what is wrong with the sensors' mounting
  Counters counters;                  ///< weather on the way from the sensors to the map
};

/// Of every scan, as is known now.
std::vector<StampedPose> poses_of(const Slam& slam);

/// Fills in all that SLAM knows at the end; live poses, times and counters are left as they are.
void take_result(Slam& slam, MappingResult& result);

}  // namespace dynslam
