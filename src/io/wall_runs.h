// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <Eigen/Geometry>

#include "grid/trinary_map.h"

namespace dynslam {

/// The rectangle around the occupied cells, metres, map frame; empty when there are none. The outermost one
/// in 500 on each side may lie outside: what was seen through a window should not make the building small.
Eigen::AlignedBox2d walls_box_map(const TrinaryMap& map);

/// The occupied cells as path data of SVG, `cells` by `cells` in one block; a block with any occupied cell is
/// a wall. A run of blocks in a row is one "M x y h n", to be drawn as a line one block thick. In blocks,
/// from the upper left corner of the map to the right and down.
std::string wall_runs(const TrinaryMap& map, int cells);

}  // namespace dynslam
