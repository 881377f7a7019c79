// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "drive/follower_config.h"
#include "sim/world.h"

namespace dynslam {

/// How an exploration went that knew the world.
struct Yardstick {
  double time_s = 0.0, way_m = 0.0;
  double seen = 0.0;  ///< the share of the reachable floor, 0 to 1
  std::size_t routes = 0;
};

/// How long a robot would explore a world that it knows. It drives to the nearest frontier: to seen floor
/// beside floor that it could reach and has not seen yet, along the planner's routes over the true floor, and
/// looks for another as soon as that frontier is gone. What it sees is what the beams of its lidar reach in
/// the true world. Its time is that of its way at the follower's speed, and of all its turns at the
/// follower's rate; it needs none to think, to speed up or to slow down.
///
/// People are away, doors as wide open as they ever are, furniture where it stands at first. Deterministic.
Yardstick exploration_yardstick(World world, double trusted_range_m, const FollowerConfig& follower = {});

}  // namespace dynslam
