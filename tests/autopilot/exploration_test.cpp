// SPDX-License-Identifier: MIT
#include "autopilot/exploration.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "autopilot/drawn_exploration.h"

namespace dynslam {
namespace {

using std::chrono::seconds;

TEST(Exploration, GoesToTheNearestFrontier) {
  DrawnExplorer e(kTwoDoors);
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
  const ExploredFlat flat(kTwoDoors);
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
  const ExploredFlat flat(kTwoDoors);
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
  const ExploredFlat flat(kTwoDoors);
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
  const ExploredFlat flat(kTwoDoors);
  std::vector<Frontier> frontiers = flat.frontiers;
  ExplorationConfig config;
  config.nook_way_m = 0.01;
  for (Frontier& f : frontiers) f.beyond_m2 = 10.0;
  EXPECT_EQ(
      Exploration(config).places(Time(), flat.robot, frontiers, VisitMap(), flat.map, flat.reach()).size(),
      2U);
}

TEST(Exploration, WhatIsNarrowIsNotWorthTheRiskOfWhatIsNotSeen) {
  const ExploredFlat flat(kTwoDoors);
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
  const ExploredFlat flat(kTwoDoors);
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
  DrawnExplorer e(kTwoDoors);
  const Vector2 first = e.places()[0].point_map;
  Rows moved = kTwoDoors;
  moved[2] = "................R.............";  // 0.3 m nearer to the other door
  const ExploredFlat later(moved);
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
  without.places(e.now, ExploredFlat(kTwoDoors).robot, later.frontiers, e.visits, later.map,
                 ExploredFlat(kTwoDoors).reach());
  EXPECT_NE(again(without), first);
}

TEST(Exploration, StaysWithAFrontierThatMovesAsItIsSeen) {
  DrawnExplorer e(kTwoDoors);
  e.places();
  for (Frontier& f : e.flat.frontiers) f.middle_map.y() += 0.3;
  e.flat.frontiers[1].extent_m = 2.9;
  EXPECT_LT(e.places()[0].point_map.x(), 0.2) << "the other one is better by too little";
  e.exploration = Exploration();
  EXPECT_GT(e.places()[0].point_map.x(), 2.8) << "but it is better";
}

TEST(Exploration, TurnsAwayWhenAnotherIsClearlyBetter) {
  DrawnExplorer e(kTwoDoors);
  const Vector2 first = e.places()[0].point_map;
  Rows moved = kTwoDoors;
  moved[2] = "...........................R..";
  e.flat = ExploredFlat(moved);
  EXPECT_NE(e.places()[0].point_map, first);
}

TEST(Exploration, LeavesAloneWhatFailedAndGivesItUpInTheEnd) {
  DrawnExplorer e(kTwoDoors);
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
  DrawnExplorer e(kTwoDoors);
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
    DrawnExplorer e(kTwoDoors);
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
  DrawnExplorer e(kTwoDoors);
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
  DrawnExplorer e(kTwoDoors);
  for (Frontier& f : e.flat.frontiers) f.extent_m = 1.5;
  for (const Place& door : e.places()) e.exploration.reached(e.now, door);
  e.places();
  EXPECT_EQ(e.exploration.left_out().waiting, 2U);
  EXPECT_EQ(e.exploration.left_out().next, std::nullopt);
}

TEST(Exploration, ADoorThatOpensAgainIsNotLeftAlone) {
  DrawnExplorer e(kTwoDoors);
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
  DrawnExplorer e(kTwoDoors);
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
  DrawnExplorer e(kTwoDoors);
  const auto places = e.places();
  ASSERT_EQ(places.size(), 2U);
  for (Frontier& f : e.flat.frontiers) f.is_rest = true;
  const auto later = e.places();
  ASSERT_EQ(later.size(), 1U);
  EXPECT_EQ(later[0].point_map, places[0].point_map);
}

TEST(Exploration, WaitsAtTheLastLookOnlyForWhatMayBeADoor) {
  for (const double extent_m : {0.4, 1.0}) {
    DrawnExplorer e(kTwoDoors);
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
  DrawnExplorer e(kTwoDoors);
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
    DrawnExplorer e(kTwoDoors);
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
  DrawnExplorer e({"####################",  //
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
  DrawnExplorer e(kTwoDoors);
  EXPECT_LT(e.places()[0].point_map.x(), 0.2);
  Rows closed = kTwoDoors;
  for (std::size_t r = 2; r < 9; ++r) closed[r][0] = '#';
  e.flat = ExploredFlat(closed);
  ASSERT_EQ(e.places().size(), 1U);
  EXPECT_GT(e.places()[0].point_map.x(), 2.8);
}

TEST(Exploration, SeesAFrontierFromWhereItCanBeApproached) {
  // 0.6 m of room is left to either wall.
  DrawnExplorer e(kTwoDoors);
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

TEST(Exploration, PassesOverNonsense) {
  const double nan = std::nan("");
  DrawnExplorer e(kTwoDoors);
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
  DrawnExplorer room(kClosedRoom);
  for (const double far : {1e5, -1e300}) {
    room.flat.robot = {far, 0.5};
    EXPECT_TRUE(room.places().empty()) << "outside of its map";
  }
  EXPECT_TRUE(Exploration()
                  .places(e.now, {0, 0}, {}, VisitMap(), {}, DrawnExplorer(kClosedRoom).flat.reach())
                  .empty());
}

}  // namespace
}  // namespace dynslam
