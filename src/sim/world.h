// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/pose2.h"
#include "sim/fault.h"
#include "sim/geometry.h"

/// A world as data: what stands in it, what moves in it and when. Its frame is the world's own, metres, z up
/// from the floor; times are seconds after the simulation began. `line` is where the world file says it, 0
/// for worlds that were made by code.
namespace dynslam {

/// 0xRRGGBB.
using Colour = std::uint32_t;

/// A solid between two heights: a polygon, or with a radius a circle about the one point. In the frame of the
/// thing it is part of.
struct Part {
  Polygon outline;
  double radius_m = 0.0;
  double low_m = 0.0, high_m = 1.0;
  Colour colour = 0xb0a090;
  double dark = 0.0;   ///< the share of beams that it swallows
  bool glass = false;  ///< beams pass unless they meet it squarely
};

struct Wall {
  std::vector<Vector2> points;  ///< the middle of the wall
  double thickness_m = 0.1, height_m = 2.5;
  bool glass = false;
  Colour colour = 0xe9e4d8;
  int line = 0;
};

/// To be `open` (0 closed to 1 wide open) from a time on.
struct DoorMove {
  double at_s = 0.0, open = 0.0;
};

struct Door {
  std::string name;
  Vector2 hinge = Vector2::Zero(), latch = Vector2::Zero();  ///< where its leaf begins and ends when closed
  double opens_rad = 0.0;  ///< how far it swings; counter-clockwise is positive
  double open = 1.0;       ///< at the start
  std::vector<DoorMove> schedule;
  double speed_radps = 1.5;
  double height_m = 2.0;
  Colour colour = 0xb98a5e;
  int line = 0;
};

enum class RouteEnd { kBack, kRound, kStay };

struct Pause {
  std::size_t at_point = 0;
  double lasts_s = 0.0;
};

struct Person {
  std::string name;
  std::vector<Vector2> route;
  RouteEnd then = RouteEnd::kBack;
  std::vector<Pause> pauses;
  double speed_mps = 1.0;
  double starts_at_s = 0.0;
  Colour colour = 0x3b6ea5;  ///< of the shirt
  int line = 0;
};

struct FurnitureMove {
  double at_s = 0.0, lasts_s = 2.0;
  Pose2 to;
};

struct Furniture {
  std::string name;
  Pose2 world_T_thing;
  std::vector<Part> parts;
  std::vector<FurnitureMove> moves;
  int line = 0;
};

/// A low strip across a doorway that wheels climb.
struct Doorstep {
  Vector2 from = Vector2::Zero(), to = Vector2::Zero();
  double depth_m = 0.08, height_m = 0.008;
  int line = 0;
};

enum class FloorPattern { kPlain, kPlanks, kTiles, kCarpet };

/// What the floor looks like; it has no height. Later ones lie on earlier ones.
struct FloorPatch {
  Polygon outline;
  Colour colour = 0xb08d62;
  FloorPattern pattern = FloorPattern::kPlain;
  int line = 0;
};

struct ScheduledFault {
  SimDevice device = SimDevice::kLidar;
  FaultKind kind = FaultKind::kUnplugged;
  double at_s = 0.0, until_s = 0.0;
};

/// Somebody carries the robot off.
struct ScheduledKick {
  double at_s = 0.0;
  Pose2 robot_T_new;
};

struct World {
  std::string name;
  Pose2 world_T_start;
  std::vector<Vector2> tour;  ///< points to drive to, in order
  std::vector<Wall> walls;
  std::vector<Door> doors;
  std::vector<Person> people;
  std::vector<Furniture> furniture;
  std::vector<Doorstep> doorsteps;
  std::vector<FloorPatch> floors;
  std::vector<ScheduledFault> faults;
  std::vector<ScheduledKick> kicks;  ///< in the order of time
  int start_line = 0, tour_line = 0;
};

/// A world that comes with the program, by its name, or the one in a file. Throws InputError with all
/// problems at once, one line each: "FILE:LINE: what is wrong".
World load_world(const std::string& name_or_path);
/// The same from text; `place` stands for the file's name in messages.
World parse_world(std::string_view text, const std::string& place);
std::vector<std::string> builtin_world_names();

/// A plan of the world for people to look at: rooms, furniture, swings of doors, routes, and the tour.
std::string to_svg(const World& world);

}  // namespace dynslam
