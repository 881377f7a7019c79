// SPDX-License-Identifier: MIT
// Where exploring goes when no frontier is left.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "autopilot/drawn_exploration.h"
#include "autopilot/exploration.h"

namespace dynslam {
namespace {

using std::chrono::seconds;

TEST(Exploration, GoesWhereItNeverWasWhenNoFrontierIsLeft) {
  DrawnExplorer e(kClosedRoom);
  EXPECT_TRUE(e.flat.frontiers.empty());
  e.visits.note(e.now, e.flat.robot);
  const auto places = e.places();
  ASSERT_EQ(places.size(), 4U * 2U - 1U) << "all history cells of the room but its own";
  double before_m = 0.0;
  for (const Place& p : places) {
    EXPECT_EQ(p.kind, PlaceKind::kUnvisited);
    EXPECT_NE(cell_at(p.point_map, kHistoryCell_m), cell_at(e.flat.robot, kHistoryCell_m));
    EXPECT_GE(p.route_m, before_m);
    before_m = p.route_m;
  }
}

/// Against all cells of a random maze, whatever the order in which the rings come.
TEST(Exploration, TheNearestUnvisitedCellIsFirstByItsRoute) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    Rows rows(50, std::string(50, '.'));
    for (int wall = 0; wall < 12; ++wall) {
      const auto at = random() % 50, from = random() % 50, length = random() % 40;
      for (auto i = from; i < std::min<std::size_t>(50, from + length); ++i)
        (wall % 2 == 0 ? rows[at][i] : rows[i][at]) = '#';
    }
    rows[random() % 50][random() % 50] = 'R';
    DrawnExplorer e(rows);
    e.flat.frontiers.clear();
    for (int i = 0; i < 40; ++i)
      e.visits.note(e.now,
                    cell_centre({static_cast<int>(random() % 10), static_cast<int>(random() % 10)}, 0.5));
    double least_m = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 100; ++i) {
      const auto route_m = e.flat.reach().route_m(cell_centre({i % 10, i / 10}, 0.5));
      if (route_m && !e.visits.last_visit({i % 10, i / 10})) least_m = std::min(least_m, *route_m);
    }
    const auto places = e.places();
    if (std::isinf(least_m)) {
      EXPECT_TRUE(places.empty());
    } else {
      ASSERT_FALSE(places.empty());
      EXPECT_EQ(places[0].route_m, least_m);
    }
  }
}

TEST(Exploration, GoesToTheOldestWhenItWasEverywhere) {
  DrawnExplorer e(kClosedRoom);
  e.visit_all(e.now - seconds(100));
  EXPECT_TRUE(e.places().empty()) << "nothing is old yet";
  e.visits.note(e.now - seconds(50), {1.75, 0.75});
  e.now += seconds(1740);
  const auto places = e.places();
  ASSERT_EQ(places.size(), 7U);
  for (const Place& p : places) {
    EXPECT_EQ(p.kind, PlaceKind::kOld);
    EXPECT_NE(p.point_map, (Vector2{1.75, 0.75}));
  }
  e.visits.note(e.now - seconds(2000), {1.25, 0.75});
  EXPECT_EQ(e.places()[0].point_map, (Vector2{1.25, 0.75}));
}

TEST(Exploration, ACellThatFailsIsTriedLaterAgain) {
  DrawnExplorer e(kClosedRoom);
  const Place cell = e.places()[0];
  const auto is_offered = [&] {
    const auto places = e.places();
    return std::any_of(places.begin(), places.end(),
                       [&](const Place& p) { return p.point_map == cell.point_map; });
  };
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(is_offered());
    e.exploration.failed(e.now, cell);
    EXPECT_FALSE(is_offered());
    e.now += seconds(60);
  }
  EXPECT_FALSE(is_offered()) << "three times is enough for a while";
  e.now += seconds(1740);
  EXPECT_TRUE(is_offered());
  EXPECT_EQ(e.exploration.left_out().next, std::nullopt) << "cells do not keep exploring from its end";
}

TEST(Exploration, AnOldCellThatWasReachedLetsTheNextOneHaveItsTurn) {
  DrawnExplorer e(kClosedRoom);
  e.visit_all(e.now - seconds(2000));
  const auto first = e.places();
  e.exploration.reached(e.now, first[0]);  // and yet the robot was not quite in it
  ASSERT_FALSE(e.places().empty());
  EXPECT_NE(e.places()[0].point_map, first[0].point_map);
  for (int i = 0; i < 10; ++i) {
    e.now += seconds(61);
    EXPECT_EQ(e.places()[0].point_map, first[0].point_map);
    e.exploration.reached(e.now, first[0]);
  }
}

}  // namespace
}  // namespace dynslam
