// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "drive/obstacle_points.h"
#include "drive/sight.h"

namespace dynslam {

/// A lidar is blind to what is very near (RPLIDAR A3: 0.2 m from its middle, which is beside the robot's
/// corners): a door leaf that came so near is still there though no beam says so. Keeps what was seen there
/// last, carried along as the robot moves, in those directions from which nothing comes back. What stood
/// still while it was seen is where it was, but for what is not seen; what came suddenly is taken to be
/// nearer. One thread.
class NearMemory {
 public:
  /// Points nearer to the lidar than this are hidden.
  explicit NearMemory(double blind_m) : blind_m_(blind_m) {}

  /// Adds what is remembered to the points of a newer scan, which are as obstacle_points() gives them.
  void add_to(std::vector<ObstaclePoint>& points, const Look& look, const BodyConfig& body);
  void forget() { near_ = {}; }

 private:
  struct Seen {
    Vector2 at;  ///< from the robot at the last scan's end
    Time seen;   ///< last
    int times;   ///< one after the other, at the same place
  };
  using Near = std::array<std::optional<Seen>, Sight::kSectors>;

  double blind_m_;
  Near near_;  ///< by direction from the lidar
};

}  // namespace dynslam
