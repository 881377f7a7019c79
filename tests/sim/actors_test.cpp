// SPDX-License-Identifier: MIT
#include "sim/actors.h"

#include <gtest/gtest.h>

#include "sim/robot_shape.h"
#include "sim/small_world.h"

namespace dynslam {
namespace {

const Pose2 kFarAway{-50, -50, 0};

/// Runs actors on; returns the time.
double run(Actors& actors, double from_s, double to_s, const Pose2& world_T_robot = kFarAway) {
  double now = from_s;
  for (; now < to_s - 1e-9; now += 0.01) actors.step(now, 0.01, world_T_robot);
  return now;
}

/// The middle of all faces: where the one actor is.
Vector2 middle_of(const Actors& actors) {
  Vector2 low(1e9, 1e9), high(-1e9, -1e9);
  for (const Surface& s : actors.surfaces()) {
    low = low.cwiseMin(s.from);
    high = high.cwiseMax(s.from);
  }
  return (low + high) / 2;
}

World with_door() {
  World world = bare_room();
  Door door;
  door.hinge = {4, 2};
  door.latch = {4, 3};
  door.opens_rad = kPi / 2;  // it opens towards smaller x
  door.open = 1.0;
  door.schedule = {{1.0, 0.0}, {5.0, 1.0}};
  door.speed_radps = kPi / 2;
  world.doors.push_back(door);
  return world;
}

World with_person(RouteEnd then) {
  World world = bare_room();
  Person person;
  person.route = {{3, 1}, {3, 3}, {5, 3}};
  person.then = then;
  person.pauses = {{1, 2.0}};
  world.people.push_back(person);
  return world;
}

TEST(Actors, ADoorClosesAndReopensByItsSchedule) {
  Actors actors(with_door());
  double now = run(actors, 0.0, 0.9);
  EXPECT_NEAR(middle_of(actors).x(), 3.5, 0.02);
  now = run(actors, now, 1.5);
  EXPECT_GT(middle_of(actors).x(), 3.55) << "it takes a second to swing";
  EXPECT_LT(middle_of(actors).x(), 3.95);
  now = run(actors, now, 3.0);
  EXPECT_NEAR(middle_of(actors).x(), 4.0, 0.02);
  run(actors, now, 7.0);
  EXPECT_NEAR(middle_of(actors).x(), 3.5, 0.02);
}

TEST(Actors, ADoorWaitsForTheRobot) {
  Actors actors(with_door());
  const Pose2 in_the_doorway{4.0, 2.5, 0.0};
  double now = run(actors, 0.0, 4.0, in_the_doorway);
  EXPECT_LT(middle_of(actors).x(), 3.9);
  for (const Surface& s : actors.surfaces()) EXPECT_FALSE(robot_touches(in_the_doorway, s));
  run(actors, now, 4.9);
  EXPECT_NEAR(middle_of(actors).x(), 4.0, 0.02) << "and closes when it has left";
}

TEST(Actors, APersonWalksARouteAndPauses) {
  Actors actors(with_person(RouteEnd::kBack));
  double now = run(actors, 0.0, 1.0);
  EXPECT_NEAR(middle_of(actors).y(), 2.0, 0.15);
  now = run(actors, now, 3.5);
  EXPECT_NEAR(middle_of(actors).x(), 3.0, 0.15) << "pausing";
  now = run(actors, now, 6.0);
  EXPECT_NEAR(middle_of(actors).x(), 5.0, 0.2);
  run(actors, now, 11.7);
  EXPECT_NEAR(middle_of(actors).y(), 1.0, 0.35) << "and back again";
}

TEST(Actors, APersonStopsForTheRobotThenTurnsBack) {
  Actors actors(with_person(RouteEnd::kBack));
  const Pose2 in_the_way{3.0, 2.5, 0.0};
  double now = run(actors, 0.0, 3.0, in_the_way);
  for (const Surface& s : actors.surfaces()) EXPECT_FALSE(robot_touches(in_the_way, s));
  const double stood_at = middle_of(actors).y();
  EXPECT_LT(stood_at, 2.1);
  EXPECT_GT(stood_at, 1.4);
  run(actors, now, 6.7, in_the_way);
  EXPECT_LT(middle_of(actors).y(), stood_at - 0.2);
}

TEST(Actors, FurnitureMovesWhenItsTimeComes) {
  World world = bare_room();
  Furniture box = box_at(5, 3, 0.4, 0, 1);
  box.moves = {{2.0, 1.0, {6, 4, 0}}};
  world.furniture.push_back(box);
  Actors actors(world);
  double now = run(actors, 0.0, 1.9);
  EXPECT_NEAR(middle_of(actors).x(), 5.0, 1e-9);
  now = run(actors, now, 2.5);
  EXPECT_NEAR(middle_of(actors).x(), 5.5, 0.05);
  run(actors, now, 9.0);
  EXPECT_NEAR(middle_of(actors).x(), 6.0, 1e-9);
  EXPECT_NEAR(middle_of(actors).y(), 4.0, 1e-9);
}

}  // namespace
}  // namespace dynslam
