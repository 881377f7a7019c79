// SPDX-License-Identifier: MIT
#include "plan/route_lengths.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "plan/drawn_floor.h"

namespace dynslam {
namespace {

const std::vector<std::string> kRooms{"##############################",  //
                                      "#.............#..............#",  //
                                      "#.............#..............#",  //
                                      "#.............#..............#",  //
                                      "#.............#..............#",  //
                                      "#.............#..............#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "##############################",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "##############################"};

TEST(RouteLengths, AreThoseOfTheRoutes) {
  DrawnFloor floor = floor_of(kRooms);
  const Costmap map = floor.costmap();
  PathPlanner planner({}, kRadius_m);
  const Vector2 start(0.5, 1.5);
  const RouteLengths lengths = planner.reach(map, start);
  int reached = 0;
  for (double y = 0.9; y < 1.7; y += 0.17) {
    for (double x = 0.3; x < 2.8; x += 0.31) {
      const Plan plan = planner.plan(map, {start, {x, y}});
      const auto length_m = lengths.length_m({x, y});
      if (plan.outcome != PlanOutcome::kFound) continue;
      ASSERT_TRUE(length_m);
      EXPECT_NEAR(*length_m, plan.length_m, 0.1 + 0.06 * plan.length_m) << x << ", " << y;
      ++reached;
    }
  }
  EXPECT_GT(reached, 18);
}

TEST(RouteLengths, EndAtWallsAndAtTheLimit) {
  DrawnFloor floor = floor_of(kRooms);
  const Costmap map = floor.costmap();
  PathPlanner planner({}, kRadius_m);
  const RouteLengths all = planner.reach(map, {0.5, 1.0});
  EXPECT_TRUE(all.length_m({2.5, 1.5}));
  EXPECT_FALSE(all.length_m({1.5, 0.3})) << "the room below has no door";
  EXPECT_FALSE(all.length_m({0.05, 1.0})) << "in a wall";
  EXPECT_NEAR(*all.length_m({0.5, 1.0}), 0.0, 1e-6);
  const RouteLengths near = planner.reach(map, {0.5, 1.0}, 1.0);
  EXPECT_TRUE(near.length_m({1.4, 1.0}));
  EXPECT_FALSE(near.length_m({1.7, 1.0}));
}

/// A floor strewn with posts, so that the easy way is often not the short one.
DrawnFloor strewn_floor(unsigned seed) {
  DrawnFloor floor;
  floor.clear(0, 0, 8, 6);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(1, 8), y(0, 6);
  for (int i = 0; i < 60; ++i) {
    const double left = x(random), low = y(random);
    floor.occupy(left, low, left + 0.1, low + 0.1);
  }
  return floor;
}

TEST(RouteLengths, AreTheSameWhenItLooksFartherBitByBit) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    DrawnFloor floor = strewn_floor(seed);
    const Costmap map = floor.costmap();
    PathPlanner whole_planner({}, kRadius_m), planner({}, kRadius_m);
    const Vector2 start{0.5, 3.0};
    const RouteLengths whole = whole_planner.reach(map, start);
    const RouteLengths& lengths = planner.reach(map, start, 1.0);
    EXPECT_FALSE(lengths.is_whole());
    EXPECT_FALSE(lengths.length_m({2.5, 3.0}));
    for (double most_m = 2.0; !lengths.is_whole(); most_m *= 2.0) {
      ASSERT_LT(most_m, 100.0);
      planner.reach_farther(most_m);
    }
    int reached = 0;
    for (double y = 0.02; y < 6; y += 0.08) {
      for (double x = 0.02; x < 8; x += 0.08) {
        const auto expected = whole.length_m({x, y}), length_m = lengths.length_m({x, y});
        ASSERT_EQ(length_m.has_value(), expected.has_value()) << seed << ": " << x << ", " << y;
        if (!length_m) continue;
        ASSERT_NEAR(*length_m, *expected, 0.02 + 0.02 * *expected) << seed << ": " << x << ", " << y;
        ++reached;
      }
    }
    EXPECT_GT(reached, 1000);
  }
}

TEST(RouteLengths, AreWholeWhenNothingIsFartherAway) {
  DrawnFloor floor = floor_of(kRooms);
  const Costmap map = floor.costmap();
  PathPlanner planner({}, kRadius_m);
  EXPECT_TRUE(PathPlanner({}, kRadius_m).reach_farther(1.0).is_whole()) << "nothing was looked at";
  EXPECT_TRUE(planner.reach(map, {0.5, 1.0}, 50.0).is_whole());
  EXPECT_TRUE(planner.reach(map, {-1e300, 1.0}, 1.0).is_whole());
  EXPECT_FALSE(planner.reach(map, {0.5, 1.0}, 1.0).is_whole());
  EXPECT_TRUE(planner.reach_farther(std::numeric_limits<double>::infinity()).is_whole());
}

TEST(RouteLengths, NamesTheReachedPlaceFarthestFromAPoint) {
  DrawnFloor floor = floor_of(kRooms);
  const Costmap map = floor.costmap();
  PathPlanner planner({}, kRadius_m);
  const auto farthest = planner.reach(map, {0.5, 1.0}).farthest_reached({0.3, 1.5});
  ASSERT_TRUE(farthest);
  EXPECT_NEAR(farthest->x(), 2.65, 0.1);
  EXPECT_NEAR(farthest->y(), 0.95, 0.1) << "not in the room below";
  EXPECT_LT((*planner.reach(map, {0.5, 1.0}, 0.5).farthest_reached({0.3, 1.5}) - Vector2(0.5, 1.0)).norm(),
            0.6);
  EXPECT_FALSE(planner.reach(map, {-1e300, 1.0}).farthest_reached({0, 0}));
}

TEST(RouteLengths, NamesTheReachedPlaceSoFarFromAPointThatIsNearestByRoute) {
  DrawnFloor floor;
  floor.clear(0, 0, 6, 6);
  floor.occupy(3, 0, 3.1, 4);
  const Costmap map = floor.costmap();
  PathPlanner planner({}, kRadius_m);
  const RouteLengths& lengths = planner.reach(map, {1, 1});
  const Vector2 point(2.7, 1);
  const auto place = lengths.reached_away_from(point, 1.2, 1.8);
  ASSERT_TRUE(place);
  EXPECT_NEAR((*place - point).norm(), 1.5, 0.31);
  EXPECT_LT((*place - Vector2(1, 1)).norm(), 0.2) << "on the robot's side of the wall";
  EXPECT_FALSE(lengths.reached_away_from(point, 1.2, 1.2));
  EXPECT_FALSE(lengths.reached_away_from({1e9, 0}, 1.2, 1.8));
  EXPECT_FALSE(planner.reach(map, {3.05, 2}, 1.0).reached_away_from(point, 8, 9));
}

TEST(RouteLengths, NamesTheReachedPlaceNearestToAPoint) {
  DrawnFloor floor = floor_of(kRooms);
  const Costmap map = floor.costmap();
  PathPlanner planner({}, kRadius_m);
  const RouteLengths& lengths = planner.reach(map, {0.5, 1.0});
  const auto nearest = lengths.nearest_reached({1.5, 0.3}, 1.0);
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->x(), 1.5, 0.1);
  EXPECT_NEAR(nearest->y(), 0.94, 0.05);
  EXPECT_GE(map.clearance_m(*nearest), kRadius_m + 0.04 - 0.004);
  EXPECT_FALSE(lengths.nearest_reached({1.5, 0.3}, 0.4));
  EXPECT_TRUE(lengths.nearest_reached({100, 100}, std::numeric_limits<double>::infinity()));
}

TEST(RouteLengths, NamesThePlaceBeforeWhatShutsAWayThatThereWas) {
  DrawnFloor floor = floor_of(kRooms);
  Costmap map = floor.costmap();
  PathPlanner planner({}, kRadius_m);
  const Vector2 start(0.5, 1.0), beyond(2.3, 1.5);
  const RouteLengths open = planner.reach(map, start);
  EXPECT_FALSE(open.before_what_shuts(beyond, 0.2)) << "it is reached";
  floor.occupy(1.4, 0.7, 1.5, 1.3);
  map.update(floor.grid.snapshot());
  const RouteLengths shut = planner.reach(map, start);
  ASSERT_FALSE(shut.length_m(beyond));
  const auto before = shut.before_what_shuts(beyond, 0.2);
  ASSERT_TRUE(before);
  EXPECT_NEAR(before->x(), 1.2, 0.1);
  EXPECT_NEAR(before->y(), 1.0, 0.15);
  EXPECT_FALSE(shut.before_what_shuts({0.7, 1.1}, 0.2)) << "it is reached";
}

TEST(RouteLengths, NamesThePlaceNearestToARoomThatIsSeenThroughAGap) {
  for (const double deep_m : {2.0, 0.45}) {
    DrawnFloor floor;
    floor.occupy(0, -0.1, 5, 3);
    floor.clear(0.1, 0, 2, 2.9);
    floor.clear(2.1, 0, 2.1 + deep_m, 2.9);
    floor.clear(2, 1.4, 2.1, 1.7);
    const auto before = PathPlanner({}, kRadius_m)
                            .reach(floor.costmap(), {1, 1})
                            .before_what_shuts({2.1 + 0.5 * deep_m, 1.5}, 0.2);
    EXPECT_EQ(before.has_value(), deep_m > 1.0) << "a place to be, or not";
    if (before) {
      EXPECT_LT((*before - Vector2(1.75, 1.5)).norm(), 0.2);
    }
  }
}

TEST(RouteLengths, KnowWhereTheWayComesByALonePost) {
  DrawnFloor floor;
  floor.occupy(-0.1, -0.1, 4.1, 1.1);
  floor.clear(0, 0, 4, 1);
  floor.occupy(2, 0.5, 2.06, 0.56);
  const Costmap map = floor.costmap();
  PathPlanner planner({}, kRadius_m);
  const RouteLengths from_afar = planner.reach(map, {0.5, 0.5});
  ASSERT_TRUE(from_afar.length_m({3.5, 0.5}));
  EXPECT_FALSE(from_afar.leads_by_post({1, 0.5}));
  EXPECT_TRUE(from_afar.leads_by_post({1.7, 0.25})) << "to it";
  EXPECT_TRUE(from_afar.leads_by_post({3.5, 0.5})) << "past it";
  EXPECT_FALSE(from_afar.leads_by_post({50, 2})) << "outside";
  const RouteLengths from_beside = planner.reach(map, {1.7, 0.25});
  EXPECT_FALSE(from_beside.leads_by_post({0.5, 0.5})) << "away from it";
}

TEST(RouteLengths, NonsenseReachesNothing) {
  DrawnFloor floor = floor_of(kRooms);
  const Costmap map = floor.costmap();
  PathPlanner planner({}, kRadius_m);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(RouteLengths().length_m({0, 0}));
  EXPECT_FALSE(RouteLengths().nearest_reached({0, 0}, 1));
  for (const Vector2& start : {Vector2(nan, 0), Vector2(inf, 0), Vector2(500, 0)})
    EXPECT_FALSE(planner.reach(map, start).nearest_reached({1, 1}, 10));
  const RouteLengths& lengths = planner.reach(map, {0.5, 1.0});
  for (const Vector2& point : {Vector2(nan, 0), Vector2(inf, 0), Vector2(-1e300, 0)})
    EXPECT_FALSE(lengths.length_m(point));
  EXPECT_FALSE(lengths.nearest_reached({nan, 0}, 10));
  EXPECT_FALSE(lengths.nearest_reached({1, 1}, nan));
  EXPECT_FALSE(lengths.before_what_shuts({nan, 0}, 10));
  EXPECT_FALSE(RouteLengths().before_what_shuts({0, 0}, 1));
}

}  // namespace
}  // namespace dynslam
