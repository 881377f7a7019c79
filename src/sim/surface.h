// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/world.h"

namespace dynslam {

/// An upright face that beams and robots run into: straight, or a cylinder when it has a radius. World frame.
struct Surface {
  Vector2 from = Vector2::Zero();   ///< the cylinder's middle
  Vector2 along = Vector2::Zero();  ///< to its other end; the part lies to the left
  double radius_m = 0.0;
  double low_m = 0.0, high_m = 0.0;
  double dark = 0.0;
  Colour colour = 0;
  bool glass = false;
  int part = 0;  ///< the same for all faces of one part
};

/// A wall as parts with a thickness, one a straight piece, corners closed.
std::vector<Part> wall_parts(const Wall& wall);

/// Appends the faces of a part that stands at a pose.
void add_surfaces(const Part& part, const Pose2& world_T_thing, int part_id, std::vector<Surface>& surfaces);

/// All that never moves: walls and the furniture without moves.
std::vector<Surface> fixed_surfaces(const World& world);

/// Whether a point lies in a part that stands at a pose; heights do not matter.
bool is_inside(const Vector2& p, const Part& part, const Pose2& world_T_thing);

}  // namespace dynslam
