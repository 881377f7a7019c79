// SPDX-License-Identifier: MIT
#include "sim/surface.h"

#include <algorithm>

namespace dynslam {
namespace {

double signed_area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return twice / 2;
}

}  // namespace

std::vector<Part> wall_parts(const Wall& wall) {
  std::vector<Part> parts;
  for (std::size_t i = 1; i < wall.points.size(); ++i) {
    const Vector2 &from = wall.points[i - 1], &to = wall.points[i];
    const bool is_joined = wall.points.size() > 2;
    Part part;
    part.outline = strip(from, to, wall.thickness_m, is_joined ? wall.thickness_m / 2 : 0.0);
    part.high_m = wall.height_m;
    part.colour = wall.colour;
    part.glass = wall.glass;
    parts.push_back(part);
  }
  return parts;
}

void add_surfaces(const Part& part, const Pose2& world_T_thing, int part_id, std::vector<Surface>& surfaces) {
  Surface face;
  face.low_m = part.low_m;
  face.high_m = part.high_m;
  face.dark = part.dark;
  face.colour = part.colour;
  face.glass = part.glass;
  face.part = part_id;
  face.radius_m = part.radius_m;
  Polygon outline = part.outline;
  if (signed_area(outline) < 0) std::reverse(outline.begin(), outline.end());
  for (std::size_t i = 0; i < outline.size(); ++i) {
    face.from = world_T_thing * outline[i];
    face.along = world_T_thing * outline[(i + 1) % outline.size()] - face.from;
    surfaces.push_back(face);
  }
}

std::vector<Surface> fixed_surfaces(const World& world) {
  std::vector<Surface> surfaces;
  int id = 0;
  for (const Wall& wall : world.walls) {
    for (const Part& part : wall_parts(wall)) add_surfaces(part, {}, id++, surfaces);
  }
  for (const Furniture& thing : world.furniture) {
    if (!thing.moves.empty()) continue;
    for (const Part& part : thing.parts) add_surfaces(part, thing.world_T_thing, id++, surfaces);
  }
  return surfaces;
}

bool is_inside(const Vector2& p, const Part& part, const Pose2& world_T_thing) {
  const Vector2 p_thing = world_T_thing.inverse() * p;
  if (part.radius_m > 0) return (p_thing - part.outline.front()).norm() < part.radius_m;
  return is_inside(p_thing, part.outline);
}

}  // namespace dynslam
