// SPDX-License-Identifier: MIT
#include "autopilot/exploration.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "autopilot/drawn_frontiers.h"

namespace dynslam {
namespace {

using Rows = std::vector<std::string>;
using std::chrono::seconds;

/// A drawn map with a robot in it that gets through everything free, by steps up, down, left and right. 'R'
/// is where the robot is.
class Flat {
 public:
  explicit Flat(Rows rows) : rows_(std::move(rows)) {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const auto column = rows_[r].find('R');
      if (column == std::string::npos) continue;
      rows_[r][column] = '.';
      robot = cell_centre({static_cast<int>(column), static_cast<int>(rows_.size() - 1 - r)}, kLetter_m);
    }
    map = map_of(rows_);
    FrontierMap cells;
    cells.update({}, map);
    frontiers = cells.frontiers();
    spread();
  }

  Reachability reach() const {
    return {[this](const Vector2& p) -> std::optional<double> {
              const auto at = steps_.find(cell_at(p, kLetter_m));
              if (at == steps_.end()) return std::nullopt;
              return at->second * kLetter_m;
            },
            [this](const Vector2& p, double within_m) { return nearest(p, within_m); }};
  }

  Vector2 robot{0, 0};
  GridSnapshot map;
  std::vector<Frontier> frontiers;

 private:
  void spread() {
    std::deque<CellIndex> pending{cell_at(robot, kLetter_m)};
    steps_[pending.front()] = 0;
    while (!pending.empty()) {
      const CellIndex c = pending.front();
      pending.pop_front();
      for (const CellIndex n : {CellIndex{c.x + 1, c.y}, CellIndex{c.x - 1, c.y}, CellIndex{c.x, c.y + 1},
                                CellIndex{c.x, c.y - 1}}) {
        if (map.state(n) != CellState::kFree || steps_.contains(n)) continue;
        steps_[n] = steps_[c] + 1;
        pending.push_back(n);
      }
    }
  }
  std::optional<Vector2> nearest(const Vector2& p, double within_m) const {
    std::optional<Vector2> nearest;
    for (const auto& [cell, steps] : steps_) {
      const Vector2 centre = cell_centre(cell, kLetter_m);
      if ((centre - p).norm() <= within_m) nearest = centre, within_m = (centre - p).norm() - 1e-9;
    }
    return nearest;
  }

  Rows rows_;
  std::map<CellIndex, int> steps_;
};

/// A robot that explores a flat.
struct Explorer {
  explicit Explorer(const Rows& rows, const ExplorationConfig& config = {})
      : flat(rows), exploration(config) {}

  std::vector<Place> places() {
    return exploration.places(now, flat.robot, flat.frontiers, visits, flat.map, flat.reach());
  }
  void visit_all(Time at) {
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) visits.note(at, cell_centre({x, y}, kLetter_m));
    }
  }

  Flat flat;
  Exploration exploration;
  VisitMap visits;
  Time now = time_at_s(10000);
};

/// Doors into the unknown, 0.7 m to the left and 1 m far away to the right.
const Rows kTwoDoors = {
    "##############################",  //
    "#............................#",  //
    "........R.....................",  //
    "..............................",  //
    "..............................",  //
    "..............................",  //
    "..............................",  //
    "..............................",  //
    "..............................",  //
    "#............................#",  //
    "##############################",
};

const Rows kClosedRoom = {
    "####################",  //
    "#..................#",  //
    "#..................#",  //
    "#...R..............#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "####################",
};

TEST(Exploration, GoesToTheNearestFrontier) {
  Explorer e(kTwoDoors);
  const auto places = e.places();
  ASSERT_EQ(places.size(), 2U);
  for (const Place& p : places) {
    EXPECT_EQ(p.kind, PlaceKind::kFrontier);
    EXPECT_NEAR(p.gain, 0.7, 0.05);
    EXPECT_EQ(p.stand_map, p.point_map);
  }
  EXPECT_LT(places[0].point_map.x(), 0.2);
  EXPECT_NEAR(places[0].route_m, 1.1, 0.11);
  EXPECT_GT(places[1].point_map.x(), 2.8);
}

TEST(Exploration, GoesFartherForWhatShowsMore) {
  const Flat flat(kTwoDoors);
  std::vector<Frontier> frontiers = flat.frontiers;
  ASSERT_EQ(frontiers.size(), 2U);
  frontiers[1].extent_m = 2.9;
  Exploration exploration;
  const auto places = exploration.places(Time(), flat.robot, frontiers, VisitMap(), flat.map, flat.reach());
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places[0].gain, 2.9);
  EXPECT_GT(places[0].route_m, places[1].route_m);
}

TEST(Exploration, ANookIsNotWorthALongWay) {
  const Flat flat(kTwoDoors);
  std::vector<Frontier> frontiers = flat.frontiers;
  ASSERT_EQ(frontiers.size(), 2U);
  ExplorationConfig config;
  config.nook_way_m = 1.5;
  const auto places = [&] {
    return Exploration(config).places(Time(), flat.robot, frontiers, VisitMap(), flat.map, flat.reach());
  };
  for (Frontier& f : frontiers) f.beyond_m2 = 0.9 * config.nook_m2;
  ASSERT_EQ(places().size(), 1U);
  EXPECT_LT(places()[0].route_m, 1.5);
  for (Frontier& f : frontiers) f.beyond_m2 = 20.0;
  EXPECT_EQ(places().size(), 2U);
  for (Frontier& f : frontiers) f.is_short = true;
  EXPECT_EQ(places().size(), 1U) << "nor is a last look";
}

TEST(Exploration, MoreToBeSeenIsWorthALongerWay) {
  const Flat flat(kTwoDoors);
  std::vector<Frontier> frontiers = flat.frontiers;
  ExplorationConfig config;
  config.nook_way_m = 1.0;
  const auto places = [&] {
    return Exploration(config).places(Time(), flat.robot, frontiers, VisitMap(), flat.map, flat.reach());
  };
  const double far_m =
      Exploration().places(Time(), flat.robot, frontiers, VisitMap(), flat.map, flat.reach())[1].route_m;
  frontiers[0].beyond_m2 = frontiers[1].beyond_m2 = 1.1 * far_m * config.nook_m2;
  EXPECT_EQ(places().size(), 2U);
  frontiers[0].beyond_m2 = frontiers[1].beyond_m2 = 0.9 * far_m * config.nook_m2;
  EXPECT_EQ(places().size(), 1U);
}

TEST(Exploration, ARoomIsWorthAnyWay) {
  const Flat flat(kTwoDoors);
  std::vector<Frontier> frontiers = flat.frontiers;
  ExplorationConfig config;
  config.nook_way_m = 0.01;
  for (Frontier& f : frontiers) f.beyond_m2 = 10.0;
  EXPECT_EQ(
      Exploration(config).places(Time(), flat.robot, frontiers, VisitMap(), flat.map, flat.reach()).size(),
      2U);
}

TEST(Exploration, WhatIsNarrowIsNotWorthTheRiskOfWhatIsNotSeen) {
  const Flat flat(kTwoDoors);
  std::vector<Frontier> frontiers = flat.frontiers;
  Reachability reach = flat.reach();
  frontiers[0].extent_m = 0.9 * kDoor_m;
  frontiers[1].extent_m = 1.1 * kDoor_m;
  const auto places = [&] {
    return Exploration().places(Time(), flat.robot, frontiers, VisitMap(), flat.map, reach);
  };
  EXPECT_EQ(places().size(), 2U);
  reach.is_risky = [](const Vector2&) { return true; };
  ASSERT_EQ(places().size(), 1U);
  EXPECT_EQ(places()[0].gain, 1.1 * kDoor_m);
}

TEST(Exploration, NobodyWaitsForADoorToANook) {
  const Flat flat(kTwoDoors);
  std::vector<Frontier> frontiers = flat.frontiers;
  Reachability reach = flat.reach();
  reach.nearest = [](const Vector2&, double) { return std::nullopt; };
  reach.before_door = [&](const Vector2&) { return std::optional(flat.robot); };
  const auto are_places = [&] {
    const auto places = Exploration().places(Time(), flat.robot, frontiers, VisitMap(), flat.map, reach);
    return !places.empty() && places[0].kind == PlaceKind::kFrontier;
  };
  EXPECT_TRUE(are_places());
  for (Frontier& f : frontiers) f.beyond_m2 = 0.1;
  EXPECT_FALSE(are_places());
}

TEST(Exploration, DoesNotDitherBetweenTwo) {
  Explorer e(kTwoDoors);
  const Vector2 first = e.places()[0].point_map;
  Rows moved = kTwoDoors;
  moved[2] = "................R.............";  // 0.3 m nearer to the other door
  const Flat later(moved);
  const auto again = [&](Exploration& exploration) {
    return exploration.places(e.now, later.robot, later.frontiers, e.visits, later.map, later.reach())[0]
        .point_map;
  };
  Exploration fresh;
  EXPECT_NE(again(fresh), first);
  EXPECT_EQ(again(e.exploration), first) << "it is on its way";
  ExplorationConfig fickle;
  fickle.keep_m = 0.0;
  Exploration without(fickle);
  without.places(e.now, Flat(kTwoDoors).robot, later.frontiers, e.visits, later.map, Flat(kTwoDoors).reach());
  EXPECT_NE(again(without), first);
}

TEST(Exploration, StaysWithAFrontierThatMovesAsItIsSeen) {
  Explorer e(kTwoDoors);
  e.places();
  for (Frontier& f : e.flat.frontiers) f.middle_map.y() += 0.3;
  e.flat.frontiers[1].extent_m = 2.9;
  EXPECT_LT(e.places()[0].point_map.x(), 0.2) << "the other one is better by too little";
  e.exploration = Exploration();
  EXPECT_GT(e.places()[0].point_map.x(), 2.8) << "but it is better";
}

TEST(Exploration, TurnsAwayWhenAnotherIsClearlyBetter) {
  Explorer e(kTwoDoors);
  const Vector2 first = e.places()[0].point_map;
  Rows moved = kTwoDoors;
  moved[2] = "...........................R..";
  e.flat = Flat(moved);
  EXPECT_NE(e.places()[0].point_map, first);
}

TEST(Exploration, LeavesAloneWhatFailedAndGivesItUpInTheEnd) {
  Explorer e(kTwoDoors);
  const Place door = e.places()[0];
  for (int i = 1; i <= 3; ++i) {
    e.exploration.failed(e.now, door);
    ASSERT_EQ(e.places().size(), 1U) << i;
    EXPECT_NE(e.places()[0].point_map, door.point_map);
    EXPECT_EQ(e.exploration.left_out().next, i < 3 ? std::optional(e.now + seconds(60)) : std::nullopt);
    EXPECT_EQ(e.exploration.left_out().waiting, i < 3 ? 1U : 0U);
    EXPECT_EQ(e.exploration.left_out().given_up, i < 3 ? 0U : 1U);
    e.now += seconds(59);
    EXPECT_EQ(e.places().size(), 1U);
    e.now += seconds(1);
    EXPECT_EQ(e.places().size(), i < 3 ? 2U : 1U);
  }
  e.now += seconds(100000);
  EXPECT_EQ(e.places().size(), 1U) << "for good";
}

TEST(Exploration, WhatFailedIsKnownByItsPlace) {
  Explorer e(kTwoDoors);
  Place door = e.places()[0];
  door.point_map.y() += 0.4;
  e.exploration.failed(e.now, door);
  EXPECT_EQ(e.places().size(), 1U);
  e.exploration = Exploration();
  door.point_map.y() += 0.4;
  e.exploration.failed(e.now, door);
  EXPECT_EQ(e.places().size(), 2U);
}

TEST(Exploration, AFrontierThatStaysAfterItWasVisitedEnds) {
  for (const double extent_m : {0.9, 1.1}) {
    Explorer e(kTwoDoors);
    for (Frontier& f : e.flat.frontiers) f.extent_m = extent_m;
    int visits = 0;
    for (int i = 0; i < 100; ++i, e.now += seconds(30)) {
      const auto places = e.places();
      if (places.empty() || places[0].kind != PlaceKind::kFrontier) continue;
      EXPECT_EQ(places[0].tries, visits / 2);
      e.exploration.reached(e.now, places[0]);
      ++visits;
    }
    EXPECT_EQ(visits, extent_m < 1.0 ? 2 : 6) << "once or three times each";
    EXPECT_EQ(e.exploration.left_out().given_up, 2U);
  }
}

TEST(Exploration, WaitsForFrontiersThatAreLeftAloneAndGoesElsewhereMeanwhile) {
  Explorer e(kTwoDoors);
  const auto places = e.places();
  EXPECT_EQ(e.exploration.left_out().next, std::nullopt);
  e.exploration.failed(e.now, places[0]);
  e.exploration.failed(e.now + seconds(5), places[1]);
  const auto meanwhile = e.places();
  ASSERT_FALSE(meanwhile.empty());
  EXPECT_EQ(meanwhile[0].kind, PlaceKind::kUnvisited);
  EXPECT_EQ(e.exploration.left_out().waiting, 2U);
  EXPECT_EQ(e.exploration.left_out().next, e.now + seconds(60));
  e.now += seconds(60);
  EXPECT_EQ(e.places().size(), 1U);
  EXPECT_EQ(e.places()[0].point_map, places[0].point_map);
}

TEST(Exploration, NobodyWaitsForWhatWasLookedAtInVain) {
  Explorer e(kTwoDoors);
  for (Frontier& f : e.flat.frontiers) f.extent_m = 1.5;
  for (const Place& door : e.places()) e.exploration.reached(e.now, door);
  e.places();
  EXPECT_EQ(e.exploration.left_out().waiting, 2U);
  EXPECT_EQ(e.exploration.left_out().next, std::nullopt);
}

TEST(Exploration, ADoorThatOpensAgainIsNotLeftAlone) {
  Explorer e(kTwoDoors);
  Place door = e.places()[0];
  door.is_shut_off = true;
  e.exploration.reached(e.now, door);
  ASSERT_EQ(e.places().size(), 2U);
  EXPECT_EQ(e.places()[0].point_map, e.flat.frontiers[1].middle_map) << "it comes after what is new";
  Reachability shut = e.flat.reach();
  shut.nearest = [&](const Vector2& p, double within_m) {
    return p == door.point_map ? std::nullopt : e.flat.reach().nearest(p, within_m);
  };
  shut.before_door = [&](const Vector2&) { return std::optional(e.flat.robot); };
  const auto while_shut =
      e.exploration.places(e.now, e.flat.robot, e.flat.frontiers, e.visits, e.flat.map, shut);
  EXPECT_EQ(while_shut.size(), 1U) << "it was looked at a moment ago";
  EXPECT_EQ(e.exploration.left_out().next, e.now + seconds(60));
}

TEST(Exploration, AFrontierCountsWhenItWasThereForAWhile) {
  Explorer e(kTwoDoors);
  const std::vector<Frontier> both = e.flat.frontiers;
  ASSERT_EQ(both.size(), 2U);
  e.flat.frontiers = {both[0]};
  EXPECT_EQ(e.places().size(), 1U) << "all count that were there first";
  e.flat.frontiers = both;
  for (int i = 0; i < 3; ++i, e.now += seconds(1)) EXPECT_EQ(e.places().size(), 1U) << i;
  EXPECT_EQ(e.places().size(), 2U);
  for (int i = 0; i < 10; ++i, e.now += seconds(1)) {
    e.flat.frontiers = i % 2 == 0 ? std::vector{both[0]} : both;
    EXPECT_EQ(e.places().size(), 1U) << "it flickers: " << i;
  }
}

TEST(Exploration, GoesOnToTheRestOfWhatItSetOutFor) {
  Explorer e(kTwoDoors);
  const auto places = e.places();
  ASSERT_EQ(places.size(), 2U);
  for (Frontier& f : e.flat.frontiers) f.is_rest = true;
  const auto later = e.places();
  ASSERT_EQ(later.size(), 1U);
  EXPECT_EQ(later[0].point_map, places[0].point_map);
}

TEST(Exploration, WaitsAtTheLastLookOnlyForWhatMayBeADoor) {
  for (const double extent_m : {0.4, 1.0}) {
    Explorer e(kTwoDoors);
    const auto look = [&](bool once) {
      return e.exploration.places(e.now, e.flat.robot, e.flat.frontiers, e.visits, e.flat.map, e.flat.reach(),
                                  once);
    };
    for (Frontier& f : e.flat.frontiers) f.extent_m = extent_m;
    for (const Place& place : look(false)) e.exploration.failed(e.now, place);
    look(false);
    EXPECT_TRUE(e.exploration.left_out().next);
    look(true);
    EXPECT_EQ(e.exploration.left_out().next.has_value(), extent_m > kDoor_m);
  }
}

TEST(Exploration, WhatCameBackComesAfterWhatIsNew) {
  Explorer e(kTwoDoors);
  for (Frontier& f : e.flat.frontiers) f.extent_m = 1.5;
  const auto places = e.places();
  ASSERT_EQ(places.size(), 2U);
  e.exploration.vanished(e.now, places[0]);
  const auto later = e.places();
  ASSERT_EQ(later.size(), 2U);
  EXPECT_EQ(later[0].point_map, places[1].point_map) << "though it is farther away";
  e.exploration.vanished(e.now, {PlaceKind::kOld, places[1].point_map, places[1].point_map});
  EXPECT_EQ(e.places().size(), 2U) << "of frontiers only";
}

TEST(Exploration, LooksOnlyAsFarAsTheBestCouldBe) {
  for (const auto& [first_m, looks] : {std::pair{0.5, 2}, std::pair{3.0, 2}, std::pair{7.0, 1}}) {
    Explorer e(kTwoDoors);
    double looked_m = first_m;
    int looked = 1;
    const Reachability all = e.flat.reach();
    const auto within = [&](std::optional<double> m) { return m && *m <= looked_m ? m : std::nullopt; };
    const Reachability reach{[&](const Vector2& p) { return within(all.route_m(p)); },
                             [&](const Vector2& p, double within_m) -> std::optional<Vector2> {
                               const auto at = all.nearest(p, within_m);
                               return at && within(all.route_m(*at)) ? at : std::nullopt;
                             },
                             [](const Vector2&) { return std::optional<Vector2>(); },
                             [&] { return looked_m; },
                             [&] {
                               if (std::isinf(looked_m)) return false;
                               looked_m = std::numeric_limits<double>::infinity();
                               ++looked;
                               return true;
                             }};
    const auto places =
        e.exploration.places(e.now, e.flat.robot, e.flat.frontiers, e.visits, e.flat.map, reach);
    EXPECT_EQ(looked, looks) << first_m;
    ASSERT_FALSE(places.empty());
    EXPECT_LT(places[0].point_map.x(), 0.2);
  }
}

TEST(Exploration, LeavesOutWhatThereIsNoRouteTo) {
  Explorer e({"####################",  //
              "#..................#",  //
              "#...R..............#",  //
              "#..................#",  //
              "####################",  //
              "#..................#",  //
              "#..................#",  //
              "                    ",  //
              "                    "},
             [] {
               ExplorationConfig near;
               near.stand_within_m = 0.2;
               return near;
             }());
  ASSERT_EQ(e.flat.frontiers.size(), 1U);
  const auto places = e.places();
  ASSERT_FALSE(places.empty());
  EXPECT_EQ(places[0].kind, PlaceKind::kUnvisited);
  EXPECT_EQ(e.exploration.left_out().out_of_reach, 1U);
  EXPECT_EQ(e.exploration.left_out().next, std::nullopt) << "nothing to wait for";
}

TEST(Exploration, ADoorThatClosedIsNoPlaceAnyMore) {
  Explorer e(kTwoDoors);
  EXPECT_LT(e.places()[0].point_map.x(), 0.2);
  Rows closed = kTwoDoors;
  for (std::size_t r = 2; r < 9; ++r) closed[r][0] = '#';
  e.flat = Flat(closed);
  ASSERT_EQ(e.places().size(), 1U);
  EXPECT_GT(e.places()[0].point_map.x(), 2.8);
}

TEST(Exploration, SeesAFrontierFromWhereItCanBeApproached) {
  // 0.6 m of room is left to either wall.
  Explorer e(kTwoDoors);
  Reachability reach = e.flat.reach();
  const auto nearest = reach.nearest;
  const auto not_near_walls = [](const Vector2& p) { return p.x() > 0.6 && p.x() < 2.4; };
  reach.nearest = [&](const Vector2& p, double within_m) -> std::optional<Vector2> {
    const Vector2 stand{std::clamp(p.x(), 0.65, 2.35), p.y()};
    return (stand - p).norm() <= within_m ? nearest(stand, 0.1) : std::nullopt;
  };
  const auto places =
      e.exploration.places(e.now, e.flat.robot, e.flat.frontiers, e.visits, e.flat.map, reach);
  ASSERT_EQ(places.size(), 2U);
  for (const Place& p : places) {
    EXPECT_TRUE(not_near_walls(p.stand_map));
    EXPECT_FALSE(not_near_walls(p.point_map));
    EXPECT_EQ(p.route_m, *reach.route_m(p.stand_map)) << "the way is to where it stands";
  }
}

TEST(Exploration, GoesWhereItNeverWasWhenNoFrontierIsLeft) {
  Explorer e(kClosedRoom);
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
    Explorer e(rows);
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
  Explorer e(kClosedRoom);
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
  Explorer e(kClosedRoom);
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
  Explorer e(kClosedRoom);
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

TEST(Exploration, PassesOverNonsense) {
  const double nan = std::nan("");
  Explorer e(kTwoDoors);
  e.flat.frontiers.push_back({{nan, 0.0}, 1.0, 50});
  EXPECT_EQ(e.places().size(), 2U);
  Reachability broken = e.flat.reach();
  broken.route_m = [nan](const Vector2&) { return nan; };
  EXPECT_TRUE(
      e.exploration.places(e.now, e.flat.robot, e.flat.frontiers, VisitMap(), e.flat.map, broken).empty());
  e.exploration.failed(e.now, {PlaceKind::kFrontier, {nan, nan}, {}, 0.0, 0.0});
  e.exploration.reached(e.now, {PlaceKind::kOld, {nan, nan}, {}, 0.0, 0.0});
  EXPECT_EQ(e.places().size(), 2U);
  for (const double x : {nan, std::numeric_limits<double>::infinity()}) {
    e.flat.robot = {x, 0.5};
    EXPECT_TRUE(e.places().empty());
  }
  Explorer room(kClosedRoom);
  for (const double far : {1e5, -1e300}) {
    room.flat.robot = {far, 0.5};
    EXPECT_TRUE(room.places().empty()) << "outside of its map";
  }
  EXPECT_TRUE(
      Exploration().places(e.now, {0, 0}, {}, VisitMap(), {}, Explorer(kClosedRoom).flat.reach()).empty());
}

}  // namespace
}  // namespace dynslam
