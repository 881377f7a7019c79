// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/pose2.h"
#include "grid/trinary_map.h"

namespace dynslam {

/// A local map as a node of the graph.
struct PicturedMap {
  std::uint32_t id = 0;
  Pose2 map_T_origin;
  bool is_active = true;  ///< false: retired, its place in the graph was taken by a neighbour
};

/// Something that was measured between two local maps and is believed.
struct PicturedEdge {
  enum class Kind : std::uint8_t {
    kOdometry,  ///< from one local map to the next
    kLoop,      ///< a closure
    kTurn       ///< the IMU's: yaw alone
  };
  Kind kind = Kind::kOdometry;
  std::uint32_t a = 0, b = 0;
  double residual = 0.0;  ///< standard deviations off at the present poses
};

/// A loop that was found and is not believed.
struct PicturedLoop {
  std::uint32_t a = 0, b = 0;
  Pose2 a_T_b;  ///< where it would have put the origin of b
  std::string reason;
};

/// What a picture of the pose graph shows.
struct GraphPicture {
  std::vector<PicturedMap> maps;  ///< those that edges and loops speak of, retired ones too
  std::vector<PicturedEdge> edges;
  std::vector<PicturedLoop> refused;  ///< never became an edge
  std::vector<PicturedLoop> let_go;   ///< were closures until the others contradicted them
  std::vector<Vector2> path_map;      ///< where the robot was, in order; metres, map frame
};

/// The pose graph as a person looks at it in a browser: an SVG text, 1200 pixels wide, y up, with the walls
/// of `map` in grey behind it.
///
/// Closures are thicker and redder the farther off they stay. A loop that is not believed is a dashed line
/// from its one map to a cross where it would have put the other, with a line from there to where that is; it
/// may lead out of the picture. Figures and reasons show under the mouse, counts at the right. What cannot be
/// placed (a pose that is not finite or farther out than 1000 km, an edge of a map that is not among `maps`)
/// is left out, and counted as such; a point of the path, silently.
///
/// The same input gives the same bytes. Their number grows with the graph and the length of the path; walls
/// are drawn no finer than the picture can show.
std::string to_svg(const GraphPicture& graph, const TrinaryMap& map);

}  // namespace dynslam
