// SPDX-License-Identifier: MIT
#include "slam/loop_closer.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "slam/drawn_finished_map.h"
#include "slam/local_map.h"
#include "support_matchers.h"

namespace dynslam {
namespace {

/// Corridors around a block, 9 x 7 m, with a few things in them. Neighbouring corners share a corridor,
/// opposite ones see nothing of each other.
DrawnWorld ring() {
  DrawnWorld world;
  world.add_box(0.007, 0.011, 9.013, 7.009);
  world.add_box(1.607, 1.611, 7.413, 5.409);
  world.add_box(3.0, 0.011, 3.5, 0.4);
  world.add_box(4.6, 1.3, 4.9, 1.611);
  world.add_box(8.6, 2.2, 9.013, 3.1);
  world.add_box(7.413, 4.0, 7.7, 4.2);
  world.add_box(5.6, 6.5, 6.6, 7.009);
  world.add_box(2.9, 5.409, 3.2, 5.6);
  world.add_box(0.007, 3.4, 0.3, 4.8);
  world.walls.push_back({{0, 0.6}, {0.6, 0}});
  world.walls.push_back({{8.2, 0}, {9, 0.3}});
  return world;
}
constexpr Pose2 kCorners[] = {{0.8, 0.8, 0}, {8.2, 0.8, 1.5}, {8.2, 6.2, 3.1}, {0.8, 6.2, -1.5}};

Pose2 corner(std::uint32_t lap_place) { return kCorners[lap_place % 4]; }

/// A robot that goes round, with the graph and the loop closer of a back end.
class Tour {
 public:
  Tour(const DrawnWorld& world, double sigma_m, double sigma_rad)
      : world_(world), odometry_(spread(sigma_m, sigma_rad)) {}

  /// The next map is made around `world_T_origin`; on the way there, odometry slipped by `slip`.
  bool go_to(const Pose2& world_T_origin, const Pose2& slip = {}) {
    return go_to(world_T_origin, slip, odometry_);
  }
  /// The same for a robot that was carried about on the way and knows it.
  bool go_to_lost(const Pose2& world_T_origin, const Pose2& slip) {
    return go_to(world_T_origin, slip, spread(kLost_m, kLost_rad));
  }

  double worst_m() const {
    double most = 0;
    for (const GraphNode& n : graph.nodes())
      most = std::max(most, (n.map_T_node.translation() - truth[n.id].translation()).norm());
    return most;
  }

  std::vector<Pose2> truth;
  PoseGraph graph;
  LoopCloser closer{graph};

 private:
  bool go_to(const Pose2& world_T_origin, const Pose2& slip, const Eigen::Matrix3d& covariance) {
    const auto id = static_cast<std::uint32_t>(truth.size());
    if (id == 0) {
      graph.add_node(0, world_T_origin);
    } else {
      const Pose2 step = truth.back().inverse() * world_T_origin * slip;
      graph.add_node(id, graph.pose(id - 1) * step);
      graph.add_odometry_edge(id - 1, id, step, covariance);
    }
    truth.push_back(world_T_origin);
    std::vector<Pose2> way;
    for (const double along : {0.0, 0.3, -0.3}) way.push_back(world_T_origin * Pose2{along, 0.2 * along, 0});
    auto map = std::make_shared<FinishedMap>(finished_map(
        world_, {.world_T_robot = way, .drawn_T_world = {0.3 * id, -0.2 * id, 0.7 * id}, .seed = id + 1}));
    map->id = id;
    return closer.close(map);
  }

  DrawnWorld world_;
  Eigen::Matrix3d odometry_;
};

const Pose2 kSlip{0.3, -0.25, radians(6)};

TEST(LoopCloser, ClosesAReturnAndTakesTheDriftOut) {
  Tour tour(ring(), 0.03, 0.01);
  for (std::uint32_t i = 0; i < 4; ++i) tour.go_to(corner(i));
  EXPECT_TRUE(tour.go_to(corner(4), {0.05, -0.04, 0.01}));
  EXPECT_GT(tour.worst_m(), 0.06);
  EXPECT_TRUE(tour.graph.solve().let_go.empty());
  EXPECT_LT(tour.worst_m(), 0.02);
  EXPECT_EQ(tour.closer.counters()["loops.refused.inconsistent"], 0U);
}

TEST(LoopCloser, OfPlacesThatShareNothingClosesNothing) {
  Tour tour(ring(), 0.03, 0.01);
  EXPECT_FALSE(tour.go_to(corner(0)));
  EXPECT_FALSE(tour.go_to(corner(1)));
  EXPECT_FALSE(tour.go_to(corner(2)));
  EXPECT_EQ(tour.closer.closures(), 0U);
}

TEST(LoopCloser, BelievesLoopsThatAgreeThatOdometrySlipped) {
  for (const Pose2& slip : {kSlip, Pose2{-0.05, 0.4, radians(6)}}) {
    Tour tour(ring(), 0.05, 0.02);
    for (std::uint32_t i = 0; i < 8; ++i) {
      if (tour.go_to(corner(i))) tour.graph.solve();
    }
    EXPECT_LT(tour.worst_m(), 0.02);
    EXPECT_FALSE(tour.go_to(corner(8), slip));
    const Counters& counters = tour.closer.counters();
    EXPECT_GE(counters["loops.refused.inconsistent"], 1U) << "one place alone is not believed";
    EXPECT_EQ(counters["loops.claims_believed"], 0U);
    EXPECT_GT(tour.worst_m(), 0.35);
    for (std::uint32_t i = 9; i < 16 && counters["loops.claims_believed"] == 0; ++i) {
      if (!tour.go_to(corner(i))) continue;
      EXPECT_TRUE(tour.graph.solve().let_go.empty());
    }
    EXPECT_GE(counters["loops.claims_believed"], 3U);
    EXPECT_LT(tour.worst_m(), 0.03) << "and puts the maps right";
  }
}

TEST(LoopCloser, ALoopFoundTwiceIsOneWitness) {
  Tour tour(ring(), 0.02, 0.008);
  for (std::uint32_t i = 0; i < 4; ++i) tour.go_to(corner(i));
  tour.go_to(corner(4), kSlip);  // found in the window that odometry allows and in the wide one
  EXPECT_EQ(tour.closer.counters()["loops.refused.inconsistent"], 2U);
  tour.go_to(corner(5));
  EXPECT_EQ(tour.closer.counters()["loops.claims_believed"], 0U) << "two loops are not three";
  tour.go_to(corner(6));
  EXPECT_EQ(tour.closer.counters()["loops.claims_believed"], 3U);
}

TEST(LoopCloser, ForgetsTheClaimsOfARetiredMap) {
  for (const std::uint32_t gone : {0U, 4U}) {
    Tour tour(ring(), 0.02, 0.008);
    for (std::uint32_t i = 0; i < 4; ++i) tour.go_to(corner(i));
    tour.go_to(corner(4), kSlip);
    tour.go_to(corner(5));
    tour.closer.forget(gone);
    tour.go_to(corner(6));  // with the claim of 4 on 0 they would be three
    EXPECT_EQ(tour.closer.counters()["loops.claims_believed"], 0U) << gone;
    for (const GraphEdge& e : tour.graph.edges())
      EXPECT_TRUE(e.kind != EdgeKind::kLoop || e.b < 4 || e.a >= 4) << e.a << " " << e.b;
  }
}

TEST(LoopCloser, NeverBelievesClaimsThatDisagree) {
  Tour tour(ring(), 0.02, 0.008);
  for (std::uint32_t i = 0; i < 4; ++i) tour.go_to(corner(i));
  const Pose2 slips[] = {kSlip, {-0.3, 0, radians(-4)}, {0.3, 0.1, radians(-7)}, {0, 0.4, radians(8)}};
  for (std::uint32_t i = 4; i < 8; ++i) tour.go_to(corner(i), slips[i - 4]);
  EXPECT_GE(tour.closer.counters()["loops.refused.inconsistent"], 3U);
  EXPECT_EQ(tour.closer.counters()["loops.claims_believed"], 0U);
  for (const GraphEdge& e : tour.graph.edges())
    EXPECT_TRUE(e.kind != EdgeKind::kLoop || e.b < 4 || e.a >= 4) << e.a << " " << e.b;
}

TEST(LoopCloser, FindsARobotThatWasLostHoweverItIsTurnedOnceThreeLoopsAgree) {
  for (const Pose2& carried : {Pose2{1.0, -2.0, 2.5}, Pose2{-1.5, 1.5, -1.6}}) {
    Tour tour(ring(), 0.03, 0.01);
    for (const double x : {0.8, 2.0, 3.2, 4.4}) tour.go_to({x, 0.8, 0});
    const std::uint64_t before = tour.closer.closures();
    EXPECT_FALSE(tour.go_to_lost({0.9, 0.9, 0}, carried));
    EXPECT_GT(tour.worst_m(), 1.5);
    EXPECT_EQ(tour.closer.closures(), before) << "one place alone is not believed";
    EXPECT_TRUE(is_anyones_guess(*tour.graph.relative_covariance(3, 4)));
    for (const double x : {1.5, 2.1, 2.7})
      if (tour.closer.counters()["loops.claims_believed"] == 0) tour.go_to({x, 0.8, 0});
    EXPECT_GE(tour.closer.counters()["loops.claims_believed"], 3U);
    EXPECT_TRUE(tour.graph.solve().let_go.empty());
    EXPECT_LT(tour.worst_m(), 0.05);
    EXPECT_FALSE(is_anyones_guess(*tour.graph.relative_covariance(3, 4)));
  }
}

/// A room with a shelf and two boxes in it, 4 x 3 m.
void add_furnished_room(DrawnWorld& world, double x) {
  world.add_box(x + 0.007, 0.011, x + 4.013, 3.009);
  world.add_box(x + 0.5, 2.2, x + 1.7, 2.6);
  world.add_box(x + 2.9, 0.6, x + 3.3, 1.1);
  world.walls.push_back({{x, 0.9}, {x + 0.8, 0}});
}

TEST(LoopCloser, DoesNotFoldRoomsThatLookAlike) {
  DrawnWorld world;
  add_furnished_room(world, 0);
  add_furnished_room(world, 5);
  for (const double sigma_m : {0.02, 0.3}) {
    Tour tour(world, sigma_m, 0.02);
    for (const double room : {0.0, 5.0}) {
      for (const Pose2& at : {Pose2{1.2, 1.3, 0}, {2.2, 1.7, 1}, {2.4, 1.4, 2}, {1.5, 1.2, 3}})
        tour.go_to(Pose2{room, 0, 0} * at);
    }
    EXPECT_GE(tour.closer.closures(), 4U) << "each room is recognised";
    for (const GraphEdge& e : tour.graph.edges())
      EXPECT_TRUE(e.kind != EdgeKind::kLoop || e.b < 4 || e.a >= 4) << sigma_m << ": " << e.a << " " << e.b;
    tour.graph.solve();
    EXPECT_LT(tour.worst_m(), 0.05) << sigma_m;
  }
}

TEST(LoopCloser, KeepsTheLastRefusalsWithTheirReasons) {
  PoseGraph graph;
  LoopCloser closer(graph);
  DrawnWorld corridor;  // too short a piece of it to be sure of
  corridor.walls = {{{-0.4, 0.5}, {0.4, 0.5}}, {{-0.4, -0.5}, {0.4, -0.5}}};
  const FinishedMap seen = finished_map(corridor, {.world_T_robot = {{0, 0, 0}}});
  for (std::uint32_t id = 0; id < 160; ++id) {
    graph.add_node(id, {});
    if (id > 0) graph.add_odometry_edge(id - 1, id, {}, spread(0.01, 0.003));
    auto map = std::make_shared<FinishedMap>(seen);
    map->id = id;
    EXPECT_FALSE(closer.close(map));
    if (id == 2) {
      ASSERT_GE(closer.refused().size(), 1U);
      EXPECT_EQ(closer.refused().front().a, 0U);
      EXPECT_EQ(closer.refused().front().b, 2U);
    }
  }
  EXPECT_EQ(closer.refused().size(), 500U);
  EXPECT_EQ(closer.refused().back().b, 159U);
  for (const RefusedLoop& loop : closer.refused()) {
    EXPECT_GT(closer.counters()["loops.refused." + loop.reason], 0U) << loop.reason;
    EXPECT_LT(loop.a, loop.b);
  }
}

TEST(LoopCloser, NotesWhatTheGraphLetGo) {
  PoseGraph graph;
  LoopCloser closer(graph);
  const Pose2 step{1, 0, 0}, wrong{0, 2, 0};
  for (std::uint32_t id = 0; id < 3; ++id) {
    graph.add_node(id, {1.0 * id, 0, 0});
    if (id > 0) graph.add_odometry_edge(id - 1, id, step, spread(0.01, 0.003));
  }
  graph.add_loop_edge(0, 2, wrong, spread(0.01, 0.003));
  closer.note_let_go(graph.solve().let_go);
  EXPECT_EQ(closer.counters()["loops.let_go"], 1U);
  ASSERT_EQ(closer.let_go().size(), 1U);
  const RefusedLoop& loop = closer.let_go().front();
  EXPECT_EQ(loop.a, 0U);
  EXPECT_EQ(loop.b, 2U);
  EXPECT_EQ(loop.a_T_b, wrong) << "where it would have put the map";
  EXPECT_THAT(loop.reason, testing::MatchesRegex("[0-9]+\\.[0-9] sigma off"));
  EXPECT_TRUE(closer.refused().empty()) << "it was believed";
  closer.forget_refused_before(2);
  EXPECT_TRUE(closer.let_go().empty()) << "nobody knows map 0";
}

TEST(LoopCloser, ForgetsRefusalsWithTheMapsTheySpeakOf) {
  Tour tour(ring(), 0.02, 0.008);
  for (std::uint32_t i = 0; i < 4; ++i) tour.go_to(corner(i));
  tour.go_to(corner(4), kSlip);
  ASSERT_FALSE(tour.closer.refused().empty());
  const std::size_t all = tour.closer.refused().size();
  tour.closer.forget_refused_before(4);
  EXPECT_EQ(tour.closer.refused().size(), all) << "its maps are there still";
  tour.closer.forget(0);
  tour.closer.forget_refused_before(4);
  for (const RefusedLoop& loop : tour.closer.refused()) EXPECT_NE(loop.a, 0U);
  EXPECT_LT(tour.closer.refused().size(), all);
}

}  // namespace
}  // namespace dynslam
