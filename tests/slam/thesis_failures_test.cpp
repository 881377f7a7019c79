// SPDX-License-Identifier: MIT
// What went wrong in the maps of the system before this one (thesis, chapter 5), drawn small.

#include <algorithm>

#include <gtest/gtest.h>

#include "slam/drawn_drive.h"

namespace dynslam {
namespace {

// ---- a ring, driven round and round by a robot that sees 2.5 m and whose IMU drifts ----

DrawnWorld ring_corridor() {
  DrawnWorld world;
  world.add_box(0.007, 0.011, 9.013, 7.009);
  world.add_box(1.807, 1.813, 7.211, 5.207);
  world.add_box(3.1, 0.02, 3.9, 0.37);
  world.add_box(7.22, 2.2, 7.4, 2.9);
  world.add_box(8.6, 4.1, 9.0, 4.9);
  world.add_box(5.0, 6.6, 5.6, 7.0);
  world.add_box(2.4, 5.21, 2.9, 5.5);
  world.add_box(0.02, 2.4, 0.4, 3.3);
  return world;
}

/// How often walls seen twice are drawn along lines across them.
struct WallCounts {
  int never = 0, once = 0, more = 0;
};

WallCounts walls_after_the_return(const SlamConfig& config) {
  Route way({1.1, 0.9, 0});
  for (int round = 0; round < 2; ++round) way.go_to(8.1, 1.0).go_to(8.0, 6.1).go_to(0.9, 6.0).go_to(1.0, 1.0);
  way.go_to(5.0, 0.95);
  DrawnDrive drive(ring_corridor(), way, config);
  drive.reach_m = 2.5;
  drive.imu = drive.fair<ImuSample>;
  drive.imu_drift_radps = radians(0.5);
  drive.until(way.end_s());
  drive.finish();
  const MapView map = drive.map();
  WallCounts counts;
  const auto probe = [&](const Vector2& from, const Vector2& to) {
    const double length = (to - from).norm();
    const Vector2 along = (to - from) / length, across(-along.y(), along.x());
    for (double s = 0; s < length; s += 0.05) {
      const Vector2 at = from + s * along;
      const std::size_t n = map.runs(at - 0.3 * across, at + 0.3 * across).size();
      ++(n == 0 ? counts.never : n == 1 ? counts.once : counts.more);
    }
  };
  probe({4.3, 0.011}, {8.6, 0.011});
  probe({2.2, 1.813}, {6.8, 1.813});
  probe({9.013, 0.5}, {9.013, 3.7});
  probe({7.211, 3.3}, {7.211, 4.8});
  probe({0.5, 7.009}, {4.6, 7.009});
  probe({0.007, 3.7}, {0.007, 6.6});
  probe({1.807, 2.2}, {1.807, 4.8});
  return counts;
}

TEST(ThesisFailures, NoWallStandsTwiceAfterTheReturn) {
  SlamConfig open;
  open.close_loops = false;
  EXPECT_GT(walls_after_the_return(open).more, 20) << "or the drift is none";
  const WallCounts counts = walls_after_the_return({});
  EXPECT_EQ(counts.more, 0);
  EXPECT_GT(counts.once, 0.95 * (counts.once + counts.never));
}

TEST(ThesisFailures, NoWallHasHolesAfterTheReturn) { EXPECT_EQ(walls_after_the_return({}).never, 0); }

// ---- a thin wall between two rooms ----

struct ThinWall {
  int lines = 0, two_faces = 0;
  double worst_off_m = 0.0;  ///< of the distance between the faces
  int free_inside = 0;
};

/// A wall of 10 cm, seen from both sides by a robot that starts at an angle to it.
ThinWall wall_between_two_rooms(double start_yaw) {
  DrawnWorld world;
  world.add_box(0.007, 0.011, 8.013, 4.009);
  world.add_box(4.003, 0.0, 4.103, 3.007);
  world.add_box(1.0, 3.4, 1.9, 4.0);
  world.add_box(6.2, 0.0, 7.4, 0.5);
  Route way({3.0, 1.0, start_yaw});
  way.go_to(3.1, 2.6).go_to(3.2, 3.5).go_to(5.0, 3.5).go_to(5.0, 1.0).go_to(6.5, 2.0);
  way.go_to(5.0, 3.5).go_to(3.2, 3.5).go_to(3.0, 1.0).go_to(1.5, 2.0);
  DrawnDrive drive(world, way);
  drive.imu = drive.fair<ImuSample>;
  drive.until(way.end_s());
  drive.finish();
  const MapView map = drive.map();
  ThinWall wall;
  for (double y = 0.2; y < 2.8; y += 0.01, ++wall.lines) {
    const auto faces = map.runs({3.7, y}, {4.4, y});
    if (faces.size() != 2) continue;
    ++wall.two_faces;
    const double apart = faces[1].middle_m() - faces[0].middle_m();
    wall.worst_off_m = std::max(wall.worst_off_m, std::abs(apart - 0.1));
  }
  wall.free_inside = map.count(CellState::kFree, {4.025, 0.2}, {4.085, 2.8});
  return wall;
}

TEST(ThesisFailures, BothFacesOfAThinWallStand) {
  const ThinWall wall = wall_between_two_rooms(0.0);
  EXPECT_EQ(wall.two_faces, wall.lines);
  EXPECT_LE(wall.worst_off_m, 0.04);
  EXPECT_EQ(wall.free_inside, 0);
}

TEST(ThesisFailures, BothFacesOfAThinWallStandAtAnyAngle) {
  for (const double yaw : {0.2, 0.4, 1.2}) {
    const ThinWall wall = wall_between_two_rooms(yaw);
    EXPECT_EQ(wall.two_faces, wall.lines) << yaw;
    EXPECT_LE(wall.worst_off_m, 0.04) << yaw;
    EXPECT_EQ(wall.free_inside, 0) << yaw;
  }
}

// ---- what newer maps do not see ----

TEST(ThesisFailures, ACornerSeenOnlyEarlyStaysWhenNewerMapsSeeTheRest) {
  DrawnWorld world;  // a room with a niche in the lower wall: its right side is hidden from the right
  const std::vector<Vector2> outline = {{0.007, 0.011},  {1.507, 0.011}, {1.507, -0.407},
                                        {2.013, -0.407}, {2.013, 0.011}, {6.007, 0.011},
                                        {6.007, 4.009},  {0.007, 4.009}, {0.007, 0.011}};
  for (std::size_t i = 1; i < outline.size(); ++i) world.walls.push_back({outline[i - 1], outline[i]});
  world.add_box(4.4, 3.2, 5.1, 3.7);
  Route way({1.4, 1.1, -1.0});
  way.go_to(2.0, 1.0).turn_by(-2.5).go_to(1.75, 1.2).turn_by(2.0);
  const double seen_s = way.end_s();
  for (int i = 0; i < 4; ++i) way.go_to(3.6, 0.9).go_to(5.2, 1.0).go_to(5.2, 2.6).go_to(3.6, 2.2);
  DrawnDrive drive(world, way);
  drive.imu = drive.fair<ImuSample>;
  drive.until(seen_s);
  const std::size_t early = drive.slam.local_maps_begun();
  drive.until(way.end_s());
  drive.finish();
  ASSERT_GT(drive.slam.local_maps_begun(), early + 8);
  const MapView map = drive.map();
  EXPECT_TRUE(map.is_occupied_near({2.013, -0.407}, 0.04));
  EXPECT_GE(map.share_drawn({{2.013, -0.38}, {2.013, -0.08}}, 0.03), 0.8) << "the hidden side";
  EXPECT_GE(map.share_drawn({{1.53, -0.407}, {1.99, -0.407}}, 0.03), 0.9) << "the back";
  const double all_cells = (0.42 / 0.02) * (0.34 / 0.02);
  EXPECT_GE(map.count(CellState::kFree, {1.55, -0.37}, {1.97, -0.03}), 0.95 * all_cells);
}

/// A box of 42 x 33 cm, circled twice.
struct CircledBox {
  static constexpr int kLines = 34;
  int lines_with_two_faces = 0;
  double width_m = 0.0, height_m = 0.0;  ///< means over these
  int outline_cells = 0, free_inside = 0;
};

CircledBox circled_box() {
  DrawnWorld world;
  world.add_box(0.007, 0.011, 4.013, 3.509);
  world.add_box(3.3, 2.9, 4.0, 3.5);
  const Vector2 low(1.803, 1.507), high(2.223, 1.837), centre = 0.5 * (low + high), half = high - centre;
  world.add_box(low.x(), low.y(), high.x(), high.y());
  Route way({1.0, 0.8, 0.3});
  for (int round = 0; round < 2; ++round) {
    way.go_to(2.0, 0.7).go_to(3.0, 0.8).go_to(3.1, 1.7).go_to(3.0, 2.5);
    way.go_to(2.0, 2.6).go_to(1.0, 2.5).go_to(0.9, 1.7).go_to(1.0, 0.8);
  }
  DrawnDrive drive(world, way);
  drive.imu = drive.fair<ImuSample>;
  drive.until(way.end_s());
  drive.finish();
  const MapView map = drive.map();
  CircledBox box;
  const auto mean_size = [&](const Vector2& along, const Vector2& across) {
    double sum = 0.0;
    int n = 0;
    for (int i = -8; i <= 8; ++i) {
      const Vector2 at = centre + 0.1 * i * along;
      const auto faces = map.runs(at - across, at + across);
      if (faces.size() == 2) sum += faces[1].middle_m() - faces[0].middle_m(), ++n;
    }
    box.lines_with_two_faces += n;
    return sum / n;
  };
  box.width_m = mean_size({0, half.y()}, {0.4, 0});
  box.height_m = mean_size({half.x(), 0}, {0, 0.4});
  const Vector2 rim(0.2, 0.2), face(0.03, 0.03);
  box.outline_cells = map.count(CellState::kOccupied, low - rim, high + rim);
  box.free_inside = map.count(CellState::kFree, low + face, high - face);
  return box;
}

TEST(ThesisFailures, ABoxThatWasCircledHasAThinOutlineOfItsSize) {
  const CircledBox box = circled_box();
  EXPECT_GE(box.lines_with_two_faces, 20);
  EXPECT_NEAR(box.width_m, 0.42, 0.02);
  EXPECT_NEAR(box.height_m, 0.33, 0.02);
  EXPECT_LT(box.outline_cells, 1.3 * (2 * (0.42 + 0.33) / 0.02)) << "for a line one cell thick";
}

TEST(ThesisFailures, ABoxThatWasCircledHasAClosedOutline) {
  const CircledBox box = circled_box();
  EXPECT_EQ(box.lines_with_two_faces, box.kLines);
  EXPECT_EQ(box.free_inside, 0);
}

// ---- what comes and goes ----

Route to_and_fro(double x0, double x1, double y, int times) {
  Route way({x0, y, 0});
  way.turn_by(1.5).turn_by(-1.5);
  for (int i = 0; i < times; ++i) way.go(x1 - x0).go(x0 - x1);
  return way;
}

/// A room that the robot has driven to and fro in until `known_s`, standing from then on or going on.
struct KnownRoom {
  static constexpr double known_s = 30.0;
  DrawnWorld room;
  DrawnDrive drive;

  explicit KnownRoom(bool stands) : room(drawn()), drive(room, way(stands)) {
    drive.imu = drive.fair<ImuSample>;
    drive.slam.follow();
    drive.until(known_s);
  }
  static DrawnWorld drawn() {
    DrawnWorld world;
    world.add_box(0.007, 0.011, 5.013, 4.009);
    world.add_box(0.1, 3.2, 0.6, 4.0);
    return world;
  }
  static DrawnDrive::Way way(bool stands) {
    const Route going = to_and_fro(1.5, 3.4, 1.0, 12);
    return [=](Time t) { return going(stands ? std::min(t, time_at_s(known_s)) : t); };
  }
};

/// A box parked in the known room, and how the map shows it.
struct ParkedBox : KnownRoom {
  using KnownRoom::KnownRoom;
  void park() { drive.world.add_box(2.2, 2.4, 2.7, 2.8); }
  void leave() { drive.world = room; }
  double share_shown() { return drive.map().share_drawn({{2.23, 2.4}, {2.67, 2.4}}, 0.03); }
  bool background_stands() {
    const MapView map = drive.map();
    return map.count(CellState::kFree, {2.2, 2.9}, {2.7, 3.9}) >= 0.99 * (0.5 / 0.02) * (1.0 / 0.02) &&
           map.share_drawn({{1.8, 4.009}, {3.1, 4.009}}, 0.03) > 0.99;
  }
};

TEST(ThesisFailures, WhatAParkedObjectHidesStaysInTheMap) {
  for (const bool stands : {false, true}) {
    ParkedBox parked(stands);
    ASSERT_TRUE(parked.background_stands());
    parked.park();
    parked.drive.until(parked.known_s + (stands ? 1.0 : 2.5));
    EXPECT_GT(parked.share_shown(), 0.9);
    EXPECT_TRUE(parked.background_stands());
    parked.drive.until(parked.known_s + 10.0);
    EXPECT_GT(parked.share_shown(), 0.9);
    EXPECT_TRUE(parked.background_stands());
    parked.drive.finish();
    EXPECT_GT(parked.share_shown(), 0.9);
    EXPECT_TRUE(parked.background_stands());
  }
}

TEST(ThesisFailures, AParkedObjectThatLeavesIsGoneWithinASecond) {
  ParkedBox parked(true);
  parked.park();
  parked.drive.until(parked.known_s + 6.0);
  parked.leave();
  for (double after_s = 1.0; after_s < 6.0; after_s += 0.1) {
    parked.drive.until(parked.known_s + 6.0 + after_s);
    EXPECT_EQ(parked.share_shown(), 0.0) << after_s;
  }
  parked.drive.finish();
  EXPECT_EQ(parked.share_shown(), 0.0);
}

TEST(ThesisFailures, AParkedObjectThatLeavesDoesNotComeBackWhileTheRobotGoesOn) {
  for (const double waited_s : {6.0, 7.0, 8.0}) {
    ParkedBox parked(false);
    parked.park();
    parked.drive.until(parked.known_s + waited_s);
    parked.leave();
    for (double after_s = 1.0; after_s < 6.0; after_s += 0.1) {
      parked.drive.until(parked.known_s + waited_s + after_s);
      EXPECT_EQ(parked.share_shown(), 0.0) << after_s << " s after it left";
    }
    parked.drive.finish();
    EXPECT_EQ(parked.share_shown(), 0.0);
  }
}

TEST(ThesisFailures, AParkedObjectIsThereWithinASecondAndStaysWhileTheRobotGoesOn) {
  ParkedBox parked(false);
  parked.park();
  for (double after_s = 1.0; after_s < 6.0; after_s += 0.1) {
    parked.drive.until(parked.known_s + after_s);
    EXPECT_GT(parked.share_shown(), 0.9) << after_s;
  }
}

/// Two rooms and a door between them that opens towards the robot.
struct Doorway {
  static constexpr double come_s = 16.0;
  DrawnDrive drive;
  double now_s = come_s, open_deg = 90;

  explicit Doorway(bool stands) : drive(drawn(90), way(stands)) {
    drive.imu = drive.fair<ImuSample>;
    drive.slam.follow();
    drive.until(now_s);
  }
  static DrawnDrive::Way way(bool stands) {
    Route going({6.5, 2.0, kPi});
    going.go_to(1.4, 2.0);
    for (int i = 0; i < 20; ++i) going.go(-1.0).go(1.0);
    return [=](Time t) { return going(stands ? std::min(t, time_at_s(come_s)) : t); };
  }
  static DrawnWorld::Wall leaf(double deg) {
    const double a = radians(deg);
    return {{3.99, 1.52}, {3.99 - 0.86 * std::sin(a), 1.52 + 0.86 * std::cos(a)}};
  }
  static DrawnWorld drawn(double deg) {
    DrawnWorld world;
    world.add_box(0.007, 0.011, 8.013, 4.009);
    world.walls.push_back({{4.003, 0}, {4.003, 1.5}});
    world.walls.push_back({{4.003, 2.4}, {4.003, 4}});
    world.walls.push_back(leaf(deg));
    world.add_box(0.1, 3.2, 0.6, 4.0);
    world.add_box(7.1, 0.1, 7.6, 1.0);
    return world;
  }
  void swing_to(double deg) {
    const double step = deg > open_deg ? 6 : -6;
    while (open_deg != deg) {
      open_deg += step;
      drive.world = drawn(open_deg);
      wait(0.1);
    }
  }
  void wait(double s) {
    now_s += s;
    drive.until(now_s);
  }
  double leaf_shown() { return drive.map().share_drawn(leaf(open_deg), 0.03); }
  /// The leaf's outer two thirds, where it stood before.
  int left_behind() {
    const MapView map = drive.map();
    int n = 0;
    for (const double deg : {0.0, 30.0, 60.0, 90.0}) {
      if (deg == open_deg) continue;
      const DrawnWorld::Wall before = leaf(deg);
      for (double share = 0.35; share < 1; share += 0.02)
        n += map.at(before.from + share * (before.to - before.from)) == CellState::kOccupied ? 1 : 0;
    }
    return n;
  }
  /// The widest gap in the doorway that is free all through.
  double way_through_m() {
    const MapView map = drive.map();
    double widest = 0.0, wide = 0.0;
    for (double y = 1.54; y < 2.36; y += 0.01) {
      bool free = true;
      for (double x = 3.7; x < 4.3; x += 0.01) free = free && map.at(x, y) == CellState::kFree;
      wide = free ? wide + 0.01 : 0.0;
      widest = std::max(widest, wide);
    }
    return widest;
  }
};

TEST(ThesisFailures, ADoorLeavesNoFanBehind) {
  Doorway door(true);
  for (const double deg : {60.0, 30.0, 0.0, 90.0}) {
    door.swing_to(deg);
    door.wait(1.2);
    EXPECT_GT(door.leaf_shown(), 0.8) << deg;
    EXPECT_EQ(door.left_behind(), 0) << deg;
  }
  door.drive.finish();
  EXPECT_EQ(door.left_behind(), 0);
}

TEST(ThesisFailures, ADoorLeavesNoFanBehindWhileTheRobotGoesOn) {
  Doorway door(false);
  for (const double deg : {60.0, 30.0, 0.0, 90.0}) {
    door.swing_to(deg);
    door.wait(1.2);
    for (int i = 0; i < 20; ++i, door.wait(0.1)) {
      EXPECT_GT(door.leaf_shown(), 0.8) << deg << " after " << 0.1 * i;
      EXPECT_EQ(door.left_behind(), 0) << deg << " after " << 0.1 * i;
    }
  }
}

TEST(ThesisFailures, AClosedDoorIsAWallAndAnOpenOneAWay) {
  for (const bool stands : {false, true}) {
    Doorway door(stands);
    EXPECT_GT(door.way_through_m(), 0.75);
    door.swing_to(0);
    door.wait(1.2);
    EXPECT_LT(door.way_through_m(), 0.06);
    door.wait(8.0);
    EXPECT_LT(door.way_through_m(), 0.03);
    door.swing_to(90);
    door.wait(stands ? 1.2 : 6.0);
    EXPECT_GT(door.way_through_m(), 0.75);
    door.wait(8.0);
    door.drive.finish();
    EXPECT_GT(door.way_through_m(), 0.75);
  }
}

TEST(ThesisFailures, TheWayThroughADoorStaysOpenWhenTheRobotGoesOn) {
  Doorway door(false);
  door.swing_to(0);
  door.wait(6.0);
  door.swing_to(90);
  door.wait(1.0);
  for (int i = 0; i < 40; ++i, door.wait(0.1)) EXPECT_GT(door.way_through_m(), 0.75) << 0.1 * i;
}

// ---- a doorstep ----

/// A robot that tips back by 3 degrees in a doorway and does not come back: its lidar sees a line on the
/// floor of the room it leaves.
class Doorstep : public DrawnDrive {
 public:
  explicit Doorstep(double tips_for_s) : DrawnDrive(drawn(), way()) {
    nose_down_rad = [tips_for_s](Time t) {
      const double s = seconds_of(t) - tips_s;
      return s > 0 && s < tips_for_s ? -radians(3) * std::min({1.0, s / 0.06, (tips_for_s - s) / 0.06}) : 0.0;
    };
    slam.follow();
  }
  static DrawnWorld drawn() {
    DrawnWorld world;
    world.add_box(0.007, 0.011, 9.013, 5.009);
    world.walls.push_back({{5.003, 0}, {5.003, 2.0}});
    world.walls.push_back({{5.003, 2.9}, {5.003, 5}});
    world.add_box(0.1, 4.2, 0.6, 5.0);
    world.add_box(8.1, 0.1, 8.6, 1.0);
    return world;
  }
  static Route way() {
    Route way({1.5, 2.5, 0});
    way.go_to(2.5, 2.4).go_to(4.9, 2.4).stand(13.7 - way.end_s());
    return way.go_to(7.0, 2.4).go_to(7.0, 4.0).go_to(6.5, 1.0).go_to(7.5, 2.4).go_to(7.0, 4.0);
  }
  static constexpr double tips_s = 12.0;
};

TEST(ThesisFailures, ADoorstepLeavesNoFloorInTheMap) {
  for (const double tips_for_s : {0.3, 1.5}) {
    Doorstep drive(tips_for_s);
    drive.imu = drive.fair<ImuSample>;
    for (double after_s = 0.1; after_s < 2.5; after_s += 0.1) {
      drive.until(drive.tips_s + after_s);
      EXPECT_EQ(drive.map().share_off(drive.world, 0.05), 0.0) << after_s;
    }
    drive.until(Doorstep::way().end_s());
    drive.finish();
    EXPECT_EQ(drive.map().share_off(drive.world, 0.05), 0.0);
    EXPECT_LT(drive.worst_m(), 0.03);
  }
}

TEST(ThesisFailures, AStepWouldLeaveFloorInTheMapIfNothingToldOfTheTilt) {
  Doorstep drive(1.5);
  drive.until(drive.tips_s + 1.5);
  EXPECT_GT(drive.map().share_off(drive.world, 0.05), 0.02) << "or the test above shows nothing";
}

// ---- people ----

void add_leg(DrawnWorld& world, const Vector2& at) {
  constexpr int kSides = 8;
  const auto corner = [&](int i) {
    const double a = i * kTwoPi / kSides;
    return Vector2(at + 0.06 * Vector2(std::cos(a), std::sin(a)));
  };
  for (int i = 0; i < kSides; ++i) world.walls.push_back({corner(i), corner(i + 1)});
}

/// How far a person has come who crosses the room and stops for a moment on the way.
double walked_m(double s) { return 0.8 * (std::min(s, 2.0) + std::max(0.0, s - 4.0)); }

TEST(ThesisFailures, APersonWalkingByLeavesNoTrail) {
  for (const bool stands : {false, true}) {
    KnownRoom known(stands);
    DrawnDrive& drive = known.drive;
    const auto trail = [&](double to_x) {
      return drive.map().count(CellState::kOccupied, {0.7, 2.6}, {to_x, 3.4});
    };
    int standing = 0;
    for (int i = 0; i <= 60; ++i) {
      const double s = 0.1 * i, x = 0.9 + walked_m(s), stride = 0.25 * std::sin(kTwoPi * 1.1 * walked_m(s));
      drive.world = known.room;
      add_leg(drive.world, {x + stride, 2.9});
      add_leg(drive.world, {x - stride, 3.1});
      drive.until(known.known_s + s + 0.1);
      standing = std::max(standing, trail(4.9));
      EXPECT_EQ(trail(0.9 + walked_m(s - 1.2) - 0.35), 0) << "where the person was a second ago, at " << s;
    }
    EXPECT_GT(standing, 5) << "the person stopped, and was there";
    drive.world = known.room;
    for (double after_s = 1.2; after_s < 6.0; after_s += 0.1) {
      drive.until(known.known_s + 6.1 + after_s);
      EXPECT_EQ(trail(4.9), 0) << after_s << " s after";
    }
    drive.finish();
    EXPECT_EQ(trail(4.9), 0);
  }
}

}  // namespace
}  // namespace dynslam
