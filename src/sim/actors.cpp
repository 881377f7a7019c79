// SPDX-License-Identifier: MIT
#include "sim/actors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sim/robot_shape.h"

namespace dynslam {
namespace {

constexpr double kLeafThickness_m = 0.04;
constexpr double kPersonRadius_m = 0.25;
constexpr double kPersonReach_m = 0.36;  ///< of a leg in mid-stride, and a little
constexpr double kLookAhead_m = 0.3;
constexpr double kPatience_s = 5.0;
constexpr double kGap_m = 0.03;
constexpr double kForesight_s = 0.6;  ///< who moves a door minds where the robot is driving

Colour mixed(Colour c, double share) {
  Colour out = 0;
  for (const int shift : {16, 8, 0}) {
    out |= static_cast<Colour>(static_cast<double>((c >> shift) & 255U) * share) << shift;
  }
  return out;
}

Part cylinder(const Vector2& at, double radius_m, double low_m, double high_m, Colour colour) {
  Part part;
  part.outline = {at};
  part.radius_m = radius_m;
  part.low_m = low_m;
  part.high_m = high_m;
  part.colour = colour;
  return part;
}

constexpr int kPersonParts = 8;

/// Legs that swing as far as the person has walked, a body and a head; in the person's frame, facing along x.
std::array<Part, kPersonParts> person_parts(const Person& person, double walked_m) {
  const double swing = 0.2 * std::sin(walked_m / 0.7 * kPi);
  const Colour trousers = 0x2f3848;
  return {{cylinder({swing, 0.1}, 0.07, 0.0, 0.86, trousers),
           cylinder({-swing, -0.1}, 0.07, 0.0, 0.86, trousers),
           cylinder({0, 0}, 0.19, 0.82, 1.45, person.colour),
           cylinder({-swing / 2, 0.23}, 0.05, 0.80, 1.40, mixed(person.colour, 0.85)),
           cylinder({swing / 2, -0.23}, 0.05, 0.80, 1.40, mixed(person.colour, 0.85)),
           cylinder({0, 0}, 0.06, 1.45, 1.52, 0xd8a583), cylinder({0, 0}, 0.1, 1.52, 1.74, 0xd8a583),
           cylinder({-0.02, 0}, 0.105, 1.68, 1.77, 0x4a3524)}};
}

bool touches_robot(const Part& part, const Pose2& world_T_thing, const Pose2& world_T_robot) {
  if (part.low_m >= kRobotHigh_m || part.high_m <= kRobotLow_m) return false;
  if (is_inside(world_T_robot.translation(), part, world_T_thing)) return true;
  if (part.radius_m > 0) {
    return distance_to_robot(world_T_robot, world_T_thing * part.outline.front()) < part.radius_m + kGap_m;
  }
  for (std::size_t i = 0; i < part.outline.size(); ++i) {
    const Vector2 from = world_T_thing * part.outline[i];
    const Vector2 to = world_T_thing * part.outline[(i + 1) % part.outline.size()];
    if (distance_to_robot(world_T_robot, from, to) < kGap_m) return true;
  }
  return false;
}

}  // namespace

Actors::Actors(const World& world) {
  for (const Door& door : world.doors) doors_.push_back({door, door.open, std::nullopt});
  for (const Person& person : world.people) {
    PersonState state{person, person.route.front()};
    const Vector2 ahead = person.route[1] - person.route[0];
    state.heading_rad = std::atan2(ahead.y(), ahead.x());
    for (const Pause& pause : person.pauses) {
      if (pause.at_point == 0) state.pause_left_s = pause.lasts_s;
    }
    people_.push_back(state);
  }
  for (const Furniture& thing : world.furniture) {
    if (thing.moves.empty()) {
      first_part_ += static_cast<int>(thing.parts.size());
    } else {
      furniture_.push_back({thing, thing.world_T_thing, thing.world_T_thing});
    }
  }
  for (const Wall& wall : world.walls) first_part_ += static_cast<int>(wall.points.size()) - 1;
}

std::vector<Vector2> Actors::reach(const World& world) {
  std::vector<Vector2> points;
  const auto add_disc = [&](const Vector2& p, double r) {
    for (const double side : {-r, r}) points.emplace_back(p.array() + side);
  };
  for (const Door& door : world.doors) add_disc(door.hinge, (door.latch - door.hinge).norm() + 0.1);
  for (const Person& person : world.people) {
    for (const Vector2& p : person.route) add_disc(p, 0.5);
  }
  for (const Furniture& thing : world.furniture) {
    double radius = 0.0;
    for (const Part& part : thing.parts) {
      for (const Vector2& p : part.outline) radius = std::max(radius, p.norm() + part.radius_m);
    }
    add_disc(thing.world_T_thing.translation(), radius);
    for (const FurnitureMove& move : thing.moves) add_disc(move.to.translation(), radius);
  }
  add_disc(world.world_T_start.translation(), 1.0);
  return points;
}

std::pair<Vector2, Vector2> Actors::DoorState::leaf(double share) const {
  const Vector2 across = door.latch - door.hinge;
  const double angle = std::atan2(across.y(), across.x()) + share * door.opens_rad;
  return {door.hinge, door.hinge + (across.norm() - 0.01) * unit(angle)};
}

bool Actors::step_door(DoorState& state, double now_s, double dt_s, const Pose2& world_T_robot) const {
  double wanted = state.door.open;
  for (const DoorMove& move : state.door.schedule) {
    if (now_s >= move.at_s) wanted = move.open;
  }
  wanted = state.told.value_or(wanted);
  if (wanted == state.open || state.door.opens_rad == 0) return false;
  const double most = state.door.speed_radps * dt_s / std::abs(state.door.opens_rad);
  const double next = state.open + std::clamp(wanted - state.open, -most, most);
  const auto [from, to] = state.leaf(next);
  const auto [from_now, to_now] = state.leaf(state.open);
  for (const Pose2& robot : {world_T_robot, world_T_robot_soon_}) {
    const double then_m = distance_to_robot(robot, from, to);
    const bool comes_nearer = then_m <= distance_to_robot(robot, from_now, to_now);
    if (then_m < kLeafThickness_m / 2 + kGap_m && comes_nearer) return false;
  }
  for (const PersonState& p : people_) {
    if (distance_to_segment(p.at, from, to) < kPersonRadius_m) return false;
  }
  state.open = next;
  return true;
}

bool Actors::may_walk_to(const PersonState& state, const Vector2& next, const Pose2& world_T_robot) const {
  const double now_m = distance_to_robot(world_T_robot, state.at);  // who is too near may walk away
  const auto is_too_near = [&](const Vector2& p) {
    const double then_m = distance_to_robot(world_T_robot, p);
    return then_m < kPersonReach_m && then_m <= now_m;
  };
  const Vector2 ahead = next + kLookAhead_m * (next - state.at).normalized();
  if (is_too_near(next) || is_too_near(ahead)) return false;
  return std::none_of(doors_.begin(), doors_.end(), [&](const DoorState& door) {
    const auto [from, to] = door.leaf(door.open);  // who is past it already walks on
    const double far = distance_to_segment(next, from, to);
    return far < kPersonRadius_m && far < distance_to_segment(state.at, from, to);
  });
}

void Actors::turn_to_next_point(PersonState& state) {
  const std::size_t n = state.person.route.size();
  const bool is_last = state.backwards ? state.target == 0 : state.target + 1 == n;
  if (state.person.then == RouteEnd::kRound) {
    state.target = (state.target + (state.backwards ? n - 1 : 1)) % n;
  } else if (is_last && state.person.then == RouteEnd::kStay && !state.backwards) {
    state.target = n;  // nowhere
  } else {
    if (is_last) state.backwards = !state.backwards;
    state.target += state.backwards ? -1 : 1;
  }
}

bool Actors::step_person(PersonState& state, double now_s, double dt_s, const Pose2& world_T_robot) const {
  const std::vector<Vector2>& route = state.person.route;
  if (now_s < state.person.starts_at_s || state.target >= route.size()) return false;
  if (state.pause_left_s > 0) {
    state.pause_left_s -= dt_s;
    return false;
  }
  const Vector2 way = route[state.target] - state.at;
  const double step_m = state.person.speed_mps * dt_s;
  if (way.norm() <= step_m) {
    for (const Pause& pause : state.person.pauses) {
      if (pause.at_point == state.target) state.pause_left_s = pause.lasts_s;
    }
    turn_to_next_point(state);
    return false;
  }
  const Vector2 next = state.at + step_m * way.normalized();
  if (!may_walk_to(state, next, world_T_robot)) {
    state.waited_s += dt_s;
    if (state.waited_s < kPatience_s) return false;
    state.waited_s = 0.0;
    state.backwards = !state.backwards;
    turn_to_next_point(state);
    return false;
  }
  state.waited_s = 0.0;
  const double turning = 4.0 * dt_s;  // rad
  state.heading_rad += std::clamp(turn(state.heading_rad, std::atan2(way.y(), way.x())), -turning, turning);
  state.at = next;
  state.walked_m += step_m;
  return true;
}

bool Actors::step_furniture(FurnitureState& state, double now_s, double dt_s,
                            const Pose2& world_T_robot) const {
  const auto& moves = state.thing.moves;
  if (state.next_move >= moves.size() || now_s < moves[state.next_move].at_s) return false;
  const FurnitureMove& move = moves[state.next_move];
  const double share = std::min(1.0, state.move_share + dt_s / move.lasts_s);
  const Pose2 next = interpolate(state.moved_from, move.to, share);
  for (const Part& part : state.thing.parts) {
    if (touches_robot(part, next, world_T_robot)) return false;
  }
  state.world_T_thing = next;
  state.move_share = share;
  if (share == 1.0) {
    state.moved_from = move.to;
    state.move_share = 0.0;
    ++state.next_move;
  }
  return true;
}

bool Actors::step(double now_s, double dt_s, const Pose2& world_T_robot) {
  bool moved = false;
  const Pose2 before = std::exchange(world_T_robot_, world_T_robot).value_or(world_T_robot);
  world_T_robot_soon_ = interpolate(before, world_T_robot, 1.0 + kForesight_s / dt_s);
  for (DoorState& door : doors_) moved |= step_door(door, now_s, dt_s, world_T_robot);
  for (PersonState& person : people_) moved |= step_person(person, now_s, dt_s, world_T_robot);
  for (FurnitureState& thing : furniture_) moved |= step_furniture(thing, now_s, dt_s, world_T_robot);
  return moved;
}

/// As surfaces() numbers them: after the doors.
bool Actors::is_of_person(const Surface& surface) const {
  const int first = first_part_ + static_cast<int>(doors_.size());
  return surface.part >= first && surface.part < first + kPersonParts * static_cast<int>(people_.size());
}

std::vector<Surface> Actors::surfaces() const {
  std::vector<Surface> all;
  int id = first_part_;
  for (const DoorState& state : doors_) {
    const auto [from, to] = state.leaf(state.open);
    Part leaf;
    leaf.outline = strip(from, to, kLeafThickness_m);
    leaf.high_m = state.door.height_m;
    leaf.colour = state.door.colour;
    add_surfaces(leaf, {}, id++, all);
  }
  for (const PersonState& state : people_) {
    const Pose2 world_T_person{state.at.x(), state.at.y(), state.heading_rad};
    for (const Part& part : person_parts(state.person, state.walked_m)) {
      add_surfaces(part, world_T_person, id++, all);
    }
  }
  for (const FurnitureState& state : furniture_) {
    for (const Part& part : state.thing.parts) add_surfaces(part, state.world_T_thing, id++, all);
  }
  return all;
}

}  // namespace dynslam
