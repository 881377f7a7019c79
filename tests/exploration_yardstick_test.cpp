// SPDX-License-Identifier: MIT
#include "exploration_yardstick.h"

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "sim/small_world.h"

namespace dynslam {
namespace {

TEST(ExplorationYardstick, ABareRoomIsSeenFromWhereItStands) {
  const Yardstick y = exploration_yardstick(bare_room(), 12.0);
  EXPECT_DOUBLE_EQ(y.seen, 1.0);
  EXPECT_EQ(y.time_s, 0.0);
}

TEST(ExplorationYardstick, ShortSightDrivesUntilTheFarCornersAreNear) {
  const Yardstick y = exploration_yardstick(bare_room(), 3.0);
  EXPECT_GT(y.seen, 0.99);
  // The corners in the east are sqrt(5.9^2 + 2.9^2) m away, and all that it cannot see yet lies there.
  EXPECT_GT(y.way_m, 3.0);
  EXPECT_LT(y.way_m, 12.0);
}

/// A wall across the room but for a gap in the north.
World divided_room() {
  World world = bare_room();
  world.walls.push_back({{{4, 0}, {4, 5}}});
  return world;
}

TEST(ExplorationYardstick, GoesRoundAWallThatHidesTheRest) {
  const Yardstick y = exploration_yardstick(divided_room(), 12.0);
  EXPECT_GT(y.seen, 0.99);
  EXPECT_GT(y.way_m, 2.0);
  EXPECT_LT(y.way_m, 8.0);
}

TEST(ExplorationYardstick, TheTimeIsThatOfTheWayAndOfTheTurns) {
  FollowerConfig quick_turns;
  quick_turns.turn_radps = 1e9;
  const Yardstick way = exploration_yardstick(divided_room(), 12.0, quick_turns);
  EXPECT_NEAR(way.time_s, way.way_m / FollowerConfig{}.speed_mps, 1e-6);
  const Yardstick all = exploration_yardstick(divided_room(), 12.0);
  EXPECT_EQ(all.way_m, way.way_m);
  EXPECT_GT(all.time_s, way.time_s + 0.5);
}

TEST(ExplorationYardstick, WhatACupboardClosesInIsNotMissed) {
  World world = bare_room();
  world.walls.push_back({{{5, 2}, {7, 2}, {7, 4}, {5, 4}, {5, 2}}});
  EXPECT_GT(exploration_yardstick(world, 12.0).seen, 0.99);
}

TEST(ExplorationYardstick, IsTheSameEachTime) {
  EXPECT_EQ(exploration_yardstick(load_world("apartment"), 12.0).time_s,
            exploration_yardstick(load_world("apartment"), 12.0).time_s);
}

TEST(ExplorationYardstick, SeesNearlyAllOfEachWorld) {
  for (const std::string& world : builtin_world_names()) {
    const Yardstick y = exploration_yardstick(load_world(world), 12.0);
    EXPECT_GT(y.seen, 0.98) << world;
    std::printf("%-10s %6.0f s, %6.1f m, %zu routes\n", world.c_str(), y.time_s, y.way_m, y.routes);
  }
}

}  // namespace
}  // namespace dynslam
