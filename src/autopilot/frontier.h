// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "autopilot/exploration_config.h"
#include "base/pose2.h"
#include "grid/cell_index.h"

namespace dynslam {

/// Where the known ends and it can be seen what lies beyond.
struct Frontier {
  Vector2 middle_map;     ///< of its cells the one nearest to their mean; free
  double extent_m = 0.0;  ///< the diagonal of the rectangle around it
  std::size_t cells = 0;
  double beyond_m2 = std::numeric_limits<double>::infinity();  ///< of the unknown, as far as that was looked
  bool is_rest = false;   ///< less than one sets out for, but one that is on its way goes on
  bool is_short = false;  ///< worth but a last look
};

/// What frontier cells make up: those that touch, corners too, are one; what is too long is cut across its
/// longer side into equal parts, what is near to each other is one again as long as it stays one place, and
/// what then is too small is noise (thesis 6.6 and 7.6). `cells`: row by row, each from left to right. In the
/// order of their middles, x first. Linear in the cells, square in what they make up.
std::vector<Frontier> find_frontiers(std::span<const CellIndex> cells, double cell_size_m,
                                     const ExplorationConfig& config);

}  // namespace dynslam
