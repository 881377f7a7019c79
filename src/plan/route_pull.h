// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "plan/ground.h"

namespace dynslam {

/// Pulls a route taut: legs are replaced by one straight leg where that is free and costs no more, found by
/// the thesis's binary search; from either end in turn, at points along the legs too. Ends stay; the route
/// never becomes dearer. REQUIRES: all points lie in the map's box.
std::vector<Vector2> pulled(std::vector<Vector2> route_map, const Costmap& map, const Ground& ground);

}  // namespace dynslam
