// SPDX-License-Identifier: MIT
#include "plan/path_planner.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "plan/drawn_floor.h"

namespace dynslam {
namespace {

constexpr double kPruned_m = kRadius_m + 0.02;

Plan plan_on(const Costmap& map, const Vector2& start, const Vector2& goal, PlannerConfig config = {},
             Unknown unknown = Unknown::kForbidden) {
  return PathPlanner(config, kRadius_m).plan(map, {start, goal, unknown});
}

/// Where a route first crosses the line x, as y.
double crossing_at(const std::vector<Vector2>& route, double x) {
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const Vector2 &a = route[i], &b = route[i + 1];
    if ((a.x() <= x) != (b.x() <= x)) return a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void expect_good(const Plan& plan, const Costmap& map, const Vector2& start, const Vector2& goal) {
  ASSERT_EQ(plan.outcome, PlanOutcome::kFound) << plan.reason;
  EXPECT_EQ(plan.route_map.front(), start);
  EXPECT_EQ(plan.route_map.back(), goal);
  EXPECT_GE(least_clearance_m(map, plan.route_map), kPruned_m);
  EXPECT_FALSE(PathPlanner({}, kRadius_m).first_blocked_leg(map, plan.route_map));
}

/// Out of where it has room the robot finds its way, though it would not plan one in.
void expect_way_out_only(const Costmap& map, const Vector2& inside, const Vector2& outside) {
  EXPECT_GT(map.clearance_m(inside), kRadius_m + 0.04);
  EXPECT_EQ(plan_on(map, outside, inside).outcome, PlanOutcome::kNoRoute);
  PathPlanner planner({}, kRadius_m);
  const Plan plan = planner.plan(map, {inside, outside});
  ASSERT_EQ(plan.outcome, PlanOutcome::kFound) << plan.reason;
  EXPECT_GT(least_clearance_m(map, plan.route_map), 0.17) << "through the middle of a gap";
  EXPECT_FALSE(planner.first_blocked_leg(map, plan.route_map));
  EXPECT_TRUE(planner.reach(map, inside).length_m(outside));
}

/// Two rooms of 3 x 4 m, a wall of 10 cm between them from x = 3, a door of 70 cm in it at y = 1.6 to 2.3.
DrawnFloor two_rooms(double door_from = 1.6, double door_to = 2.3) {
  DrawnFloor floor;
  floor.occupy(-0.1, -0.1, 6.2, 4.1);
  floor.clear(0, 0, 3, 4);
  floor.clear(3.1, 0, 6.1, 4);
  floor.clear(3, door_from, 3.1, door_to);
  return floor;
}

TEST(PathPlanner, GoesStraightWhereNothingIsInTheWay) {
  DrawnFloor floor;
  floor.clear(0, 0, 6, 4);
  const Plan plan = plan_on(floor.costmap(), {0.51, 0.52}, {5.33, 3.17});
  EXPECT_EQ(plan.outcome, PlanOutcome::kFound);
  EXPECT_EQ(plan.route_map.size(), 2U);
  EXPECT_NEAR(plan.length_m, std::hypot(4.82, 2.65), 1e-9);
  EXPECT_TRUE(plan.reason.empty());
}

TEST(PathPlanner, CrossesADoorInItsMiddle) {
  DrawnFloor floor = two_rooms();
  const Costmap map = floor.costmap();
  for (const auto& [start, goal] : {std::pair<Vector2, Vector2>{{0.6, 2}, {5.5, 2}},
                                    {{0.6, 0.5}, {5.5, 3.5}},
                                    {{0.6, 3.5}, {5.5, 3.4}},
                                    {{2.5, 0.5}, {3.6, 0.5}},
                                    {{5.5, 3.5}, {0.6, 0.7}}}) {
    const Plan plan = plan_on(map, start, goal);
    expect_good(plan, map, start, goal);
    EXPECT_NEAR(crossing_at(plan.route_map, 3.05), 1.95, 0.05)
        << start.transpose() << " to " << goal.transpose();
    EXPECT_LE(plan.route_map.size(), 14U);
  }
}

TEST(PathPlanner, ShowsThePlaceBeforeTheDoorThatIsShutNow) {
  DrawnFloor floor = two_rooms(0.2, 0.9);
  Costmap map = floor.costmap();
  const Vector2 start{0.6, 3.4}, goal{3.7, 3.6};
  EXPECT_EQ(plan_on(map, start, goal).outcome, PlanOutcome::kFound);
  floor.occupy(3.0, 0.2, 3.1, 0.9);
  map.update(floor.grid.snapshot());
  const Plan plan = plan_on(map, start, goal);
  EXPECT_EQ(plan.outcome, PlanOutcome::kNoRoute);
  ASSERT_TRUE(plan.nearest_map && plan.door_map);
  EXPECT_LT(plan.door_map->y(), 1.2) << "not as near to the goal as can be, beyond the wall";
  EXPECT_NEAR((*plan.nearest_map - *plan.door_map).norm(), 1.4, 0.25);
  EXPECT_LT((*plan.nearest_map - start).norm(), (*plan.door_map - start).norm());
  const Plan never = plan_on(two_rooms(9, 9).costmap(), start, goal);
  ASSERT_TRUE(never.nearest_map);
  EXPECT_GT(never.nearest_map->y(), 3.0) << "there never was a way";
}

TEST(PathPlanner, WaitsBeforeADoorWhereNoLeafHidesIt) {
  DrawnFloor floor = two_rooms(0.2, 0.9);
  Costmap map = floor.costmap();
  floor.occupy(3.0, 0.2, 3.1, 0.9);
  map.update(floor.grid.snapshot());
  const Vector2 start{2.6, 1.5}, goal{3.7, 3.6};
  const Plan shut = plan_on(map, start, goal);
  ASSERT_TRUE(shut.door_map && shut.nearest_map);
  EXPECT_TRUE(shut.sees_door);
  EXPECT_GT((*shut.nearest_map - *shut.door_map).norm(), 1.0) << "a leaf can open";
  // It stands open now, as wide as it goes; and what it was when shut is not seen to be gone.
  floor.occupy(2.3, 0.9, 3.0, 0.94);
  map.update(floor.grid.snapshot());
  const Plan hidden = plan_on(map, start, goal);
  ASSERT_TRUE(hidden.door_map && hidden.nearest_map);
  EXPECT_FALSE(hidden.sees_door);
  EXPECT_LT(hidden.door_map->y(), 0.9);
  EXPECT_TRUE(plan_on(map, *hidden.nearest_map, goal).sees_door);
}

TEST(PathPlanner, PrefersTheWayWithRoom) {
  const std::vector<std::string> rows{"##############################",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#......################......#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "#............................#",  //
                                      "##############################"};
  DrawnFloor floor = floor_of(rows);
  const Costmap map = floor.costmap();
  const Plan roomy = plan_on(map, {0.4, 0.5}, {2.6, 0.5});
  ASSERT_EQ(roomy.outcome, PlanOutcome::kFound);
  PlannerConfig short_cut;
  short_cut.comfort_weight = 0;
  short_cut.post_weight = 1;
  const Plan tight = plan_on(map, {0.4, 0.5}, {2.6, 0.5}, short_cut);
  EXPECT_LT(tight.length_m, 2.3) << "through the passage of 50 cm";
  EXPECT_GT(roomy.length_m, 2.8);
  EXPECT_GT(crossing_at(roomy.route_map, 1.5), 0.9) << "through the hall above";
}

/// 50 cm between the walls, for a robot that takes 2 (0.19 + 0.04) = 46: wherever it lies on the grid.
TEST(PathPlanner, PassesAPassageOf50CmWhereverItLies) {
  for (int offset = 0; offset < 8; ++offset) {
    for (const bool upright : {false, true}) {
      DrawnFloor floor;
      const double low = 1 + offset * kCell_m;
      const auto at = [&](double x, double y) { return upright ? Vector2(y, x) : Vector2(x, y); };
      const auto clear = [&](const Vector2& a, const Vector2& b) { floor.clear(a.x(), a.y(), b.x(), b.y()); };
      floor.occupy(0, 0, 4, 4);
      clear(at(0.1, 0.5), at(1.2, 2.5));
      clear(at(1.2, low), at(2.6, low + 0.5));
      clear(at(2.6, 0.5), at(3.8, 2.5));
      const Costmap map = floor.costmap();
      const Vector2 start = at(0.6, 1.5), goal = at(3.2, 1.5);
      expect_good(plan_on(map, start, goal), map, start, goal);
    }
  }
}

TEST(PathPlanner, PassesASlantingPassageOf50Cm) {
  for (const double slope_rad : {kPi / 4, -kPi / 4, 0.3, 1.1}) {
    for (int offset = 0; offset < 8; ++offset) {
      DrawnFloor floor;
      const Vector2 along(std::cos(slope_rad), std::sin(slope_rad)), across(-along.y(), along.x());
      const Vector2 middle(2 + 0.013 * offset, 2 + 0.007 * offset);
      for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 200; ++x) {
          const Vector2 p = cell_centre({x, y}, kCell_m) - middle;
          const bool in_wall = std::abs(p.dot(along)) < 0.4 && std::abs(p.dot(across)) > 0.25;
          floor.set({x, y}, in_wall);
        }
      }
      const Costmap map = floor.costmap();
      const Vector2 start = middle - 1.2 * along, goal = middle + 1.2 * along;
      const Plan plan = plan_on(map, start, goal);
      expect_good(plan, map, start, goal);
      EXPECT_LT(plan.length_m, 2.6) << "through it";
    }
  }
}

TEST(PathPlanner, DoesNotPassWhatIsTooNarrow) {
  DrawnFloor floor = two_rooms(1.6, 2.02);
  const Plan plan = plan_on(floor.costmap(), {0.6, 2}, {5.5, 2});
  EXPECT_EQ(plan.outcome, PlanOutcome::kNoRoute);
  EXPECT_EQ(plan.reason, "no way through");
  ASSERT_TRUE(plan.nearest_map);
  EXPECT_NEAR(plan.nearest_map->x(), 2.85, 0.1) << "before the wall";
  EXPECT_NEAR(plan.nearest_map->y(), 2.0, 0.3);
}

TEST(PathPlanner, GoesRoundANoGoArea) {
  DrawnFloor floor;
  floor.clear(0, 0, 6, 4);
  Costmap map = floor.costmap();
  map.set_forbidden(std::vector<std::vector<Vector2>>{{{2, -1}, {3, -1}, {3, 3}, {2, 3}}});
  map.update(floor.grid.snapshot());
  const Plan plan = plan_on(map, {1, 1}, {5, 1});
  expect_good(plan, map, {1, 1}, {5, 1});
  EXPECT_GT(crossing_at(plan.route_map, 2.5), 3.2);
  const Plan inside = plan_on(map, {1, 1}, {2.5, 1});
  EXPECT_EQ(inside.outcome, PlanOutcome::kNoRoute);
  EXPECT_EQ(inside.reason, "forbidden area");
  map.set_forbidden({});
  map.update(floor.grid.snapshot());
  EXPECT_NEAR(plan_on(map, {1, 1}, {5, 1}).length_m, 4, 1e-9);
}

TEST(PathPlanner, LeavesANoGoAreaThatItStandsIn) {
  DrawnFloor floor;
  floor.clear(0, 0, 6, 4);
  Costmap map = floor.costmap();
  map.set_forbidden(std::vector<std::vector<Vector2>>{{{1, 1}, {2, 1}, {2, 3}, {1, 3}}});
  map.update(floor.grid.snapshot());
  const Plan plan = plan_on(map, {1.8, 2}, {5, 2});
  ASSERT_EQ(plan.outcome, PlanOutcome::kFound) << plan.reason;
  EXPECT_NEAR(plan.length_m, 3.2, 0.05);
  EXPECT_FALSE(PathPlanner({}, kRadius_m).first_blocked_leg(map, plan.route_map)) << "the way out is none";

  map.set_forbidden(std::vector<std::vector<Vector2>>{{{-1, -1}, {5, -1}, {5, 5}, {-1, 5}}});
  map.update(floor.grid.snapshot());
  const Plan far = plan_on(map, {2, 2}, {5.5, 2});
  ASSERT_EQ(far.outcome, PlanOutcome::kFound) << far.reason;
  EXPECT_NEAR(far.length_m, 3.5, 0.05);
  EXPECT_FALSE(PathPlanner({}, kRadius_m).first_blocked_leg(map, far.route_map)) << "however far it is";
}

/// As beside a pane, which is kept out of as a thin area.
TEST(PathPlanner, FindsItsWayOutFromBesideANoGoAreaButNotThroughIt) {
  DrawnFloor floor;
  floor.clear(0, 0, 6, 4);
  Costmap map = floor.costmap();
  const Vector2 start(2.9, 2), goal(5, 2);
  const std::vector<Vector2> across{start, goal};
  PathPlanner planner({}, kRadius_m);
  EXPECT_FALSE(planner.first_blocked_leg(map, across));
  map.set_forbidden(std::vector<std::vector<Vector2>>{{{3, 0.9}, {3.04, 0.9}, {3.04, 4}, {3, 4}}});
  map.update(floor.grid.snapshot());
  EXPECT_EQ(planner.first_blocked_leg(map, across), 0U);
  const Plan plan = plan_on(map, start, goal);
  ASSERT_EQ(plan.outcome, PlanOutcome::kFound) << plan.reason;
  EXPECT_LT(crossing_at(plan.route_map, 3.02), 0.9);
  EXPECT_FALSE(planner.first_blocked_leg(map, plan.route_map)) << "near to it as it begins";
}

TEST(PathPlanner, FindsItsWayOutOfATightPlaceButThroughNoWall) {
  DrawnFloor floor = two_rooms();
  const Costmap map = floor.costmap();
  // 8 cm from the wall between the rooms, and the goal on the other side of it.
  const Vector2 start(2.92, 0.6), goal(3.6, 0.6);
  const Plan plan = plan_on(map, start, goal);
  ASSERT_EQ(plan.outcome, PlanOutcome::kFound) << plan.reason;
  EXPECT_EQ(plan.route_map.front(), start);
  EXPECT_GT(plan.length_m, 2.5) << "through the door";
  EXPECT_GT(least_clearance_m(map, plan.route_map), 0.07);
  std::size_t first_free = 0;
  while (map.clearance_m(plan.route_map[first_free]) < kPruned_m) ++first_free;
  EXPECT_LT((plan.route_map[first_free] - start).norm(), 0.3);
  EXPECT_GE(least_clearance_m(map, plan.route_map, first_free), kPruned_m);
}

/// It came in when the door stood a little wider open.
TEST(PathPlanner, FindsItsWayOutOfANookThroughAGapThatIsATrifleTooNarrow) {
  DrawnFloor floor;
  floor.clear(0, 0, 4, 4);
  floor.occupy(0.5, 0.5, 1.9, 1.9);
  floor.clear(0.6, 0.6, 1.8, 1.8);
  floor.clear(1.8, 1.0, 1.9, 1.0 + 2 * kPruned_m);
  expect_way_out_only(floor.costmap(), {1.2, 1.2}, {3, 3});
}

/// As behind a bed: wide enough only here and there, now that it is inside and knows better.
TEST(PathPlanner, FindsItsWayOutOfAPassageThatHasRoomOnlyHereAndThere) {
  DrawnFloor floor;
  floor.clear(0, 0, 4, 4);
  floor.occupy(2.1, 1, 3.9, 3);
  floor.clear(2.1, 1.8, 3.7, 1.8 + 2 * kPruned_m);
  for (const double x : {2.2, 2.7, 3.2}) floor.clear(x, 1.72, x + 0.34, 1.88 + 2 * kPruned_m);
  expect_way_out_only(floor.costmap(), {3.37, 2.01}, {0.6, 3.4});
}

/// Four legs with 36 cm between them: room to stand in their middle, but too little between two of them.
TEST(PathPlanner, FindsItsWayOutBetweenTheLegsOfAChair) {
  DrawnFloor floor;
  floor.clear(0, 0, 4, 4);
  for (const double x : {1.0, 1.4}) {
    for (const double y : {1.0, 1.4}) floor.occupy(x, y, x + 0.04, y + 0.04);
  }
  const Vector2 middle(1.22, 1.22), outside(3, 3);
  expect_way_out_only(floor.costmap(), middle, outside);
  // Round it a wall with a gap that is too narrow to squeeze through.
  floor.occupy(0.6, 0.6, 1.84, 1.84);
  floor.clear(0.9, 0.9, 1.54, 1.54);
  floor.clear(1.5, 1.2, 2.0, 1.28);
  EXPECT_EQ(plan_on(floor.costmap(), middle, outside).outcome, PlanOutcome::kNoRoute);
}

TEST(PathPlanner, LeavesWhereItShowsAsOccupiedItself) {
  DrawnFloor floor;
  floor.clear(0, 0, 4, 4);
  floor.occupy(0.98, 0.98, 1.06, 1.06);
  const Plan plan = plan_on(floor.costmap(), {1.01, 1.01}, {3, 3});
  ASSERT_EQ(plan.outcome, PlanOutcome::kFound) << plan.reason;
  EXPECT_LT(plan.length_m, 1.3 * std::hypot(1.99, 1.99));
}

TEST(PathPlanner, SaysWhenThereIsNoWayOut) {
  DrawnFloor floor;
  floor.clear(0, 0, 4, 4);
  floor.occupy(0.9, 0.9, 1.3, 1.3);
  floor.clear(0.94, 0.94, 1.26, 1.26);
  const Plan plan = plan_on(floor.costmap(), {1.1, 1.1}, {3, 3});
  EXPECT_EQ(plan.outcome, PlanOutcome::kNoRoute);
  EXPECT_EQ(plan.reason, "no way out from where the robot stands");
}

TEST(PathPlanner, AGoalThatIsTooTightGivesWayToAPointNearby) {
  DrawnFloor floor = two_rooms();
  const Costmap map = floor.costmap();
  for (const Vector2& goal : {Vector2(5.5, 3.95), Vector2(6.05, 2), Vector2(5.5, 4.02)}) {
    const Plan plan = plan_on(map, {0.6, 2}, goal);
    ASSERT_EQ(plan.outcome, PlanOutcome::kNearby) << plan.reason;
    EXPECT_LE((plan.route_map.back() - goal).norm(), 0.3);
    EXPECT_GE(least_clearance_m(map, plan.route_map), kPruned_m);
    EXPECT_FALSE(plan.reason.empty());
    EXPECT_FALSE(plan.nearest_map);
  }
  const Vector2 near_wall(5.5, 3.85);
  EXPECT_NEAR((plan_on(map, {0.6, 2}, near_wall).route_map.back() - near_wall).norm(), 0.09, 0.05)
      << "the nearest such point";
}

TEST(PathPlanner, SaysWhyThereIsNoWayToAGoal) {
  DrawnFloor floor = two_rooms();
  floor.occupy(4.5, 1.2, 5.3, 2.0);
  floor.clear(9, 0, 10, 1);
  const Costmap map = floor.costmap();
  const auto reason_at = [&](const Vector2& goal) {
    const Plan plan = plan_on(map, {0.6, 2}, goal);
    EXPECT_EQ(plan.outcome, PlanOutcome::kNoRoute) << goal.transpose();
    EXPECT_TRUE(plan.route_map.empty());
    EXPECT_TRUE(plan.nearest_map) << goal.transpose();
    return plan.reason;
  };
  EXPECT_EQ(reason_at({4.9, 1.6}), "a wall stands there");
  EXPECT_EQ(reason_at({7.5, 2}), "unknown ground");
  EXPECT_EQ(reason_at({9.5, 0.5}), "no way through");
  EXPECT_EQ(reason_at({40, 2}), "outside of the map");
  EXPECT_EQ(reason_at({-1e300, 1e300}), "outside of the map");
  const Plan unknown = plan_on(map, {0.6, 2}, {7.5, 2});
  EXPECT_NEAR(unknown.nearest_map->x(), 5.85, 0.09);
  EXPECT_NEAR(unknown.nearest_map->y(), 2.0, 0.09);
}

TEST(PathPlanner, RequestsThatAreNoPlacesGetNoRoute) {
  DrawnFloor floor = two_rooms();
  const Costmap map = floor.costmap();
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const auto& [start, goal] : {std::pair<Vector2, Vector2>{{nan, 1}, {1, 1}},
                                    {{1, 1}, {1, nan}},
                                    {{1, 1}, {inf, 1}},
                                    {{-inf, 1}, {1, 1}},
                                    {{500, 1}, {1, 1}}}) {
    const Plan plan = plan_on(map, start, goal);
    EXPECT_EQ(plan.outcome, PlanOutcome::kNoRoute);
    EXPECT_FALSE(plan.reason.empty());
  }
  EXPECT_EQ(plan_on(Costmap(kCell_m), {0, 0}, {1, 1}).outcome, PlanOutcome::kNoRoute) << "an empty map";
}

TEST(PathPlanner, CrossesUnknownGroundOnlyWhenItMay) {
  const std::vector<std::string> rows(20, "............          ............");
  DrawnFloor floor = floor_of(rows);
  const Costmap map = floor.costmap();
  EXPECT_EQ(plan_on(map, {0.5, 1}, {2.9, 1}).outcome, PlanOutcome::kNoRoute);
  const Plan plan = plan_on(map, {0.5, 1}, {2.9, 1}, {}, Unknown::kDear);
  ASSERT_EQ(plan.outcome, PlanOutcome::kFound) << plan.reason;
  EXPECT_NEAR(plan.length_m, 2.4, 0.01);
  EXPECT_EQ(plan_on(map, {0.5, 1}, {1.7, 1}, {}, Unknown::kDear).outcome, PlanOutcome::kFound);
  // Known ground around it is taken when it is less than three times as far.
  DrawnFloor around = floor_of(rows);
  around.clear(0, -2, 3.4, 0);
  const Plan detour = plan_on(around.costmap(), {0.5, 0.3}, {2.9, 0.3}, {}, Unknown::kDear);
  EXPECT_LT(crossing_at(detour.route_map, 1.7), 0.05);
}

TEST(PathPlanner, StopsAtItsBudget) {
  DrawnFloor floor = two_rooms();
  PlannerConfig config;
  config.most_expansions = 50;
  const Plan plan = plan_on(floor.costmap(), {0.6, 0.5}, {5.5, 3.5}, config);
  EXPECT_EQ(plan.outcome, PlanOutcome::kNoRoute);
  EXPECT_EQ(plan.reason, "too far for the planner");
  EXPECT_TRUE(plan.nearest_map);
}

TEST(PathPlanner, NamesTheFirstLegThatIsBlocked) {
  DrawnFloor floor = two_rooms();
  PathPlanner planner({}, kRadius_m);
  const std::vector<Vector2> route{{0.6, 0.6}, {1.5, 1.95}, {4, 1.95}, {5.5, 3}, {5.5, 5}};
  EXPECT_EQ(planner.first_blocked_leg(floor.costmap(), route), 3U) << "into the wall";
  EXPECT_FALSE(planner.first_blocked_leg(floor.costmap(), std::span(route).first(4)));
  floor.occupy(2, 1.9, 2.1, 2);
  EXPECT_EQ(planner.first_blocked_leg(floor.costmap(), route), 1U) << "something stands there now";
  EXPECT_FALSE(planner.first_blocked_leg(floor.costmap(), {}));
  const std::vector<Vector2> away{{0.6, 0.6}, {-1e300, 3}};
  EXPECT_EQ(planner.first_blocked_leg(floor.costmap(), away), 0U);
}

TEST(PathPlanner, NamesAnotherDoorWhenBeforeOneItWasInVain) {
  DrawnFloor floor;
  floor.clear(0, 0, 6, 6);
  floor.occupy(3, 0, 3.1, 6);
  for (const double low : {0.5, 4.5}) floor.clear(3, low, 3.1, low + 0.9);
  Costmap map(kCell_m);
  map.update(floor.grid.snapshot());
  for (const double low : {0.5, 4.5}) floor.occupy(3, low, 3.1, low + 0.9);
  map.update(floor.grid.snapshot());
  PathPlanner planner({}, kRadius_m);
  PlanRequest request{{1, 3}, {5, 1.5}};
  const Plan one = planner.plan(map, request);
  ASSERT_TRUE(one.nearest_map && one.door_map);
  EXPECT_LT(one.door_map->y(), 2.0) << "that nearer to the goal";
  request.in_vain_map.push_back(*one.door_map);
  const Plan other = planner.plan(map, request);
  ASSERT_TRUE(other.nearest_map && other.door_map);
  EXPECT_GT(other.door_map->y(), 4.0);
  EXPECT_LT(other.nearest_map->x(), 3.0);
  request.in_vain_map.push_back(*other.door_map);
  EXPECT_FALSE(planner.plan(map, request).door_map);
  EXPECT_TRUE(planner.plan(map, request).nearest_map);
}

TEST(PathPlanner, GivesTheSameRouteAgainWhateverItDidBefore) {
  DrawnFloor floor = two_rooms();
  const Costmap map = floor.costmap();
  PathPlanner planner({}, kRadius_m);
  const PlanRequest request{{0.6, 0.5}, {5.5, 3.5}};
  const Plan first = planner.plan(map, request);
  planner.plan(map, {{5.5, 0.4}, {0.5, 3.5}});
  planner.reach(map, {1, 1});
  DrawnFloor other;
  other.clear(-5, -5, 5, 5);
  planner.plan(other.costmap(), {{0, 0}, {4, 4}});
  EXPECT_EQ(planner.plan(map, request).route_map, first.route_map);
}

TEST(PlannerConfig, PruningMustNotTakeMoreRoomThanPlanning) {
  EXPECT_FALSE(PlannerConfig().problem());
  PlannerConfig config;
  config.prune_margin_m = 0.1;
  EXPECT_TRUE(config.problem());
}

}  // namespace
}  // namespace dynslam
