// SPDX-License-Identifier: MIT
#include "sim/world_check.h"

#include <algorithm>
#include <limits>

#include "base/number_text.h"
#include "sim/robot_shape.h"

namespace dynslam {
namespace {

constexpr double kDoorGap_m = 0.1;  ///< between a door's end and the wall it sits in
constexpr double kTourRoom_m =
    0.13;  ///< beside the line of a tour: somewhat more than half the robot's width
constexpr double kPersonHigh_m = 1.8;

struct Piece {
  Vector2 from, to;
  const Wall* wall;
};

std::vector<Piece> pieces_of(const World& world) {
  std::vector<Piece> pieces;
  for (const Wall& wall : world.walls) {
    for (std::size_t i = 1; i < wall.points.size(); ++i)
      pieces.push_back({wall.points[i - 1], wall.points[i], &wall});
  }
  return pieces;
}

std::string at(const Vector2& p) {
  std::string text = "(";
  append_fixed(text, p.x(), 2);
  text += ", ";
  append_fixed(text, p.y(), 2);
  return text + ')';
}

Vector2 crossing_point(const Piece& a, const Piece& b) {
  const Vector2 along = a.to - a.from, other = b.to - b.from;
  return a.from + cross(b.from - a.from, other) / cross(along, other) * along;
}

/// Whether two pieces cross well inside both; that one ends in the other is how rooms are built.
bool do_cross(const Piece& a, const Piece& b) {
  if (!segments_cross(a.from, a.to, b.from, b.to)) return false;
  const Vector2 p = crossing_point(a, b);
  const double allowance = (a.wall->thickness_m + b.wall->thickness_m) / 2;
  return std::min({(p - a.from).norm(), (p - a.to).norm(), (p - b.from).norm(), (p - b.to).norm()}) >
         allowance;
}

/// Whether they run along each other, one on the other.
bool do_cover(const Piece& a, const Piece& b) {
  const Vector2 along = (a.to - a.from).normalized();
  const auto is_on_line = [&](const Vector2& p) { return std::abs(cross(along, p - a.from)) < 0.01; };
  if (!is_on_line(b.from) || !is_on_line(b.to)) return false;
  const double begin = along.dot(b.from - a.from), end = along.dot(b.to - a.from);
  const double overlap =
      std::min((a.to - a.from).norm(), std::max(begin, end)) - std::max(0.0, std::min(begin, end));
  return overlap > 0.1;
}

std::string line_text(int line) { return "line " + std::to_string(line); }

void check_walls(const std::vector<Piece>& pieces, Problems& problems) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& a = pieces[i];
    if ((a.to - a.from).norm() < 0.01) {
      problems.add(a.wall->line, "wall: two points of it are the same, at " + at(a.from));
      continue;
    }
    for (std::size_t j = 0; j < i; ++j) {
      const Piece& b = pieces[j];
      if (do_cross(a, b)) {
        problems.add(a.wall->line, "wall: crosses the wall of " + line_text(b.wall->line) + " at " +
                                       at(crossing_point(a, b)));
      } else if (do_cover(a, b)) {
        problems.add(a.wall->line,
                     "wall: lies on the wall of " + line_text(b.wall->line) + " near " + at(a.from));
      }
    }
  }
}

bool is_at_wall(const Vector2& p, const std::vector<Piece>& pieces) {
  return std::any_of(pieces.begin(), pieces.end(), [&](const Piece& w) {
    return distance_to_segment(p, w.from, w.to) <= w.wall->thickness_m / 2 + kDoorGap_m;
  });
}

void check_door(const Door& door, const std::vector<Piece>& pieces, Problems& problems) {
  const auto fail = [&](const std::string& what) {
    problems.add(door.line, "door \"" + door.name + "\": " + what);
  };
  const Vector2 along = door.latch - door.hinge;
  if (along.norm() < 0.3)
    return fail("is " + shortest_text(along.norm()) + " m wide; a door needs 0.3 m or more");
  if (!is_at_wall(door.hinge, pieces)) fail("no wall ends at its hinge " + at(door.hinge));
  if (!is_at_wall(door.latch, pieces)) fail("no wall ends at its latch " + at(door.latch));
  const Vector2 inset = 0.15 * along;
  for (const Piece& w : pieces) {
    const double apart = distance_between_segments(door.hinge + inset, door.latch - inset, w.from, w.to);
    if (apart < w.wall->thickness_m / 2) {
      return fail("there is no opening: the wall of " + line_text(w.wall->line) + " fills it");
    }
  }
}

/// How near the line from a to b comes to a part; 0 when it meets it or lies in it.
double clearance(const Vector2& a, const Vector2& b, const Part& part, const Pose2& world_T_thing) {
  if (is_inside(a, part, world_T_thing)) return 0.0;
  if (part.radius_m > 0) {
    return std::max(0.0, distance_to_segment(world_T_thing * part.outline.front(), a, b) - part.radius_m);
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < part.outline.size(); ++i) {
    const Vector2 from = world_T_thing * part.outline[i];
    const Vector2 to = world_T_thing * part.outline[(i + 1) % part.outline.size()];
    nearest = std::min(nearest, distance_between_segments(a, b, from, to));
  }
  return nearest;
}

/// Who goes along a line, and what is in the way.
struct Mover {
  double room_m;         ///< to both sides of the line
  double low_m, high_m;  ///< what stands between these heights is in the way
};

/// The first thing that a line meets, in words for a message; empty when the way is free.
std::string obstacle_on(const Vector2& a, const Vector2& b, const World& world, const Mover& mover) {
  for (const Wall& wall : world.walls) {
    for (const Part& part : wall_parts(wall)) {
      if (clearance(a, b, part, {}) < mover.room_m) return "the wall of " + line_text(wall.line);
    }
  }
  for (const Furniture& thing : world.furniture) {
    for (const Part& part : thing.parts) {
      if (part.low_m >= mover.high_m || part.high_m <= mover.low_m) continue;
      if (clearance(a, b, part, thing.world_T_thing) < mover.room_m) {
        return thing.name + " of " + line_text(thing.line);
      }
    }
  }
  return "";
}

void check_person(const Person& person, const World& world, Problems& problems) {
  std::vector<Vector2> route = person.route;
  if (person.then == RouteEnd::kRound) route.push_back(route.front());
  for (std::size_t i = 1; i < route.size(); ++i) {
    const std::string met = obstacle_on(route[i - 1], route[i], world, {0.12, 0.05, kPersonHigh_m});
    if (met.empty()) continue;
    problems.add(person.line, "person \"" + person.name + "\": walks through " + met + " between " +
                                  at(route[i - 1]) + " and " + at(route[i]));
  }
}

void check_tour(const World& world, Problems& problems) {
  Vector2 from = world.world_T_start.translation();
  for (const Vector2& to : world.tour) {
    const std::string met = obstacle_on(from, to, world, {kTourRoom_m, kRobotLow_m, kRobotHigh_m});
    if (!met.empty()) {
      problems.add(world.tour_line, "tour: meets " + met + " between " + at(from) + " and " + at(to));
    }
    from = to;
  }
}

void check_start(const World& world, Problems& problems) {
  const Pose2& start = world.world_T_start;
  const Vector2 half = start * Vector2(kRobotLength_m / 2, 0), back = start * Vector2(-kRobotLength_m / 2, 0);
  const std::string met = obstacle_on(back, half, world, {kRobotWidth_m / 2, kRobotLow_m, kRobotHigh_m});
  if (!met.empty()) problems.add(world.start_line, "start: the robot would stand in " + met);
  for (const Door& door : world.doors) {
    const Vector2 leaf = door.latch - door.hinge;
    const double angle = std::atan2(leaf.y(), leaf.x()) + door.open * door.opens_rad;
    if (distance_to_robot(start, door.hinge, door.hinge + leaf.norm() * unit(angle)) < 0.03) {
      problems.add(world.start_line, "start: the robot would stand in the door of " + line_text(door.line));
    }
  }
  for (const Person& person : world.people) {
    if (distance_to_robot(start, person.route.front()) < 0.4) {
      problems.add(world.start_line, "start: the person of " + line_text(person.line) + " stands there");
    }
  }
}

}  // namespace

void check_world(const World& world, Problems& problems) {
  const std::vector<Piece> pieces = pieces_of(world);
  check_walls(pieces, problems);
  for (const Door& door : world.doors) check_door(door, pieces, problems);
  for (const Person& person : world.people) check_person(person, world, problems);
  if (world.start_line == 0) return;
  check_start(world, problems);
  check_tour(world, problems);
}

}  // namespace dynslam
