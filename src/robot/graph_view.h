// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "slam/pose_graph.h"

namespace dynslam {

class BackEnd;

/// Where the local maps lie that the map is made of, and which of them were recognised as the same place.
/// Bounded by the building: maps whose place a newer one took are not in it.
struct GraphView {
  struct Closure {
    std::uint32_t from = 0, to = 0;  ///< ids of local maps
  };
  std::vector<GraphNode> local_maps;  ///< by id
  std::vector<Closure> closures;
};

GraphView graph_view(const BackEnd& back_end);

}  // namespace dynslam
