// SPDX-License-Identifier: MIT
#include "slam/loop_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "slam/drawn_finished_map.h"
#include "support_matchers.h"

namespace dynslam {
namespace {

const SearchWindow kMedium{1.0, 1.0, radians(8)};
const SearchWindow kWide{3.0, 3.0, radians(20)};

/// Two maps of one world, and how they truly lie.
struct Pair {
  FinishedMap target, source;
  Pose2 truth;  ///< target_T_source
};

Pair map_twice(const DrawnWorld& world, const std::vector<Pose2>& target, const std::vector<Pose2>& source,
               const Pose2& target_frame = {}, const Pose2& source_frame = {}) {
  return {finished_map(world, {.world_T_robot = target, .drawn_T_world = target_frame, .seed = 3}),
          finished_map(world, {.world_T_robot = source, .drawn_T_world = source_frame, .seed = 4}),
          target.front().inverse() * source.front()};
}

LoopMatch search(const Pair& pair, const Pose2& guess, const SearchWindow& window,
                 const LoopSearchConfig& config = {}) {
  return find_loop(MaxPyramid(pair.target), pair.target, pair.source, guess, window, config);
}

/// The match in words, for when a test fails.
std::string said(const LoopMatch& m) {
  std::ostringstream out;
  out << refusal(m).value_or("accepted") << ": overlap " << m.overlap << ", score " << m.score << ", matched "
      << m.matched << ", contradicted " << m.contradicted << " and back " << m.contradicted_back
      << ", residual " << m.residual_m << ", runner-up " << m.runner_up << ", roundness " << m.roundness
      << ", nodes " << m.nodes;
  return out.str();
}

const std::vector<Pose2> kFirstWay = {{2, 2.5, 0}, {3.2, 3, 0}, {4.4, 2.4, 0}};
const std::vector<Pose2> kSecondWay = {{5.6, 2.6, 2.4}, {4.5, 2.5, 0}, {3.4, 1.8, 0}, {2.2, 1.6, 0}};

TEST(PyramidSearch, FindsWhatTryingEverythingFinds) {
  const FinishedMap target = finished_map(two_rooms(), {.world_T_robot = kFirstWay});
  const FinishedMap source = finished_map(two_rooms(), {.world_T_robot = kSecondWay, .seed = 2});
  const MaxPyramid pyramid(target);
  const std::vector<Vector2> points = thin_out(source.cloud, 120, 0.04);
  const Pose2 truth = kSecondWay.front();  // the target is drawn in the world's frame
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const Pose2 guess{truth.x + 0.6 * unit(random), truth.y + 0.6 * unit(random),
                      truth.yaw + 0.2 * unit(random)};
    const SearchWindow window{0.3 + 0.3 * std::abs(unit(random)), 0.2 + 0.3 * std::abs(unit(random)), 0.03};
    PyramidSearch quick(pyramid, points, guess, window, {.least_evidence = -80, .rival_m = 0.2});
    const PyramidSearchResult result = quick.run();
    ASSERT_TRUE(result.best.has_value());
    EXPECT_FALSE(result.out_of_budget);
    std::uint32_t most = 0, most_elsewhere = 0;
    for (int yaw = -quick.half_yaws(); yaw <= quick.half_yaws(); ++yaw) {
      for (int y = -quick.half_y(); y <= quick.half_y(); ++y) {
        for (int x = -quick.half_x(); x <= quick.half_x(); ++x) {
          const std::uint32_t sum = quick.score({x, y, yaw});
          most = std::max(most, sum);
          const bool elsewhere = std::hypot(x - result.best->x, y - result.best->y) * 0.04 > 0.2;
          if (elsewhere) most_elsewhere = std::max(most_elsewhere, sum);
        }
      }
    }
    EXPECT_EQ(result.best->sum, most) << trial;
    EXPECT_EQ(quick.score(*result.best), most) << trial;
    if (result.rival) {
      EXPECT_EQ(result.rival->sum, most_elsewhere) << trial;
    }
  }
}

TEST(LoopSearch, FindsRandomOffsets) {
  const Pair pair = map_twice(two_rooms(), kFirstWay, kSecondWay);
  const MaxPyramid pyramid(pair.target);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 30; ++trial) {
    const Pose2 guess{pair.truth.x + 2 * unit(random), pair.truth.y + 2 * unit(random),
                      pair.truth.yaw + radians(20) * unit(random)};
    const LoopMatch match = find_loop(pyramid, pair.target, pair.source, guess, {2.0, 2.0, radians(20)});
    EXPECT_THAT(match.target_T_source, PoseNear(pair.truth, 0.005, radians(0.1))) << said(match);
    EXPECT_EQ(refusal(match), std::nullopt) << said(match);
  }
}

TEST(LoopSearch, AgreesInShiftedAndTurnedFrames) {
  const Pose2 frames[] = {{}, {-3.213, 0.777, 0}, {1.13, -2.4, 2.2}, {105.01, 33.3, -0.9}};
  for (const Pose2& target_frame : frames) {
    for (const Pose2& source_frame : frames) {
      const Pair pair = map_twice(two_rooms(), kFirstWay, kSecondWay, target_frame, source_frame);
      const LoopMatch match = search(pair, pair.truth * Pose2{0.5, -0.6, 0.1}, kMedium);
      EXPECT_THAT(match.target_T_source, PoseNear(pair.truth, 0.005, radians(0.1))) << said(match);
      EXPECT_EQ(refusal(match), std::nullopt) << said(match);
    }
  }
}

TEST(ThinOut, KeepsToTheMiddleOfThickWalls) {
  std::vector<CloudPoint> wall;
  for (int y = -1; y <= 1; ++y) {
    for (int x = 0; x < 500; ++x)
      wall.push_back({static_cast<float>(0.02 * x), static_cast<float>(0.02 * y), 255});
  }
  const std::vector<Vector2> thin = thin_out(wall, 100, 0.02);
  EXPECT_LE(thin.size(), 100U);
  EXPECT_GT(thin.size(), 60U);
  double mean = 0;
  for (const Vector2& p : thin) mean += p.y() / static_cast<double>(thin.size());
  EXPECT_NEAR(mean, 0.0, 1e-6);
}

TEST(LoopSearch, ItsInformationFitsItsErrors) {
  const Pair pair = map_twice(two_rooms(), kFirstWay, kSecondWay);
  const LoopMatch match = search(pair, pair.truth, kMedium);
  const Eigen::Vector3d error(match.target_T_source.x - pair.truth.x, match.target_T_source.y - pair.truth.y,
                              turn(pair.truth.yaw, match.target_T_source.yaw));
  EXPECT_LT(error.dot(match.information * error), 60);
  EXPECT_GT(match.information(0, 0), 1 / (0.02 * 0.02));
  EXPECT_LT(match.information(0, 0), 1 / (0.0002 * 0.0002));
}

/// Shelves of 1 x 8 m, an aisle of 2 m between them, all alike.
DrawnWorld aisles() {
  DrawnWorld world;
  for (int i = -6; i <= 6; ++i) world.add_box(3.0 * i + 0.013, 0.011, 3.0 * i + 1.007, 8.017);
  world.walls.push_back({{-30, -2.013}, {30, -2.013}});
  world.walls.push_back({{-30, 10.009}, {30, 10.009}});
  return world;
}

TEST(LoopSearch, RefusesAislesThatLookAlike) {
  // One robot goes up an aisle, the other up the next one; or up the same, nobody can tell.
  const std::vector<Pose2> here = {{2, -1, kPi / 2}, {2, 1, 0}, {2, 4, 0}, {2, 7, 0}, {2, 9, 0}};
  std::vector<Pose2> there = here;
  for (Pose2& p : there) p.x += 3;
  const SearchWindow wide{3.5, 3.5, radians(10)};
  for (const auto& second : {here, there}) {
    const Pair pair = map_twice(aisles(), here, second);
    const LoopMatch match = search(pair, pair.truth * Pose2{0.2, 0.3, 0.02}, wide);
    EXPECT_EQ(refusal(match), "ambiguous") << said(match);
  }
  const Pair same = map_twice(aisles(), here, here);
  const LoopMatch sure = search(same, same.truth * Pose2{0.2, 0.3, 0.02}, kMedium);
  EXPECT_EQ(refusal(sure), std::nullopt) << "where odometry leaves no doubt: " << said(sure);
}

TEST(LoopSearch, RefusesABareCorridor) {
  DrawnWorld corridor;
  corridor.walls.push_back({{-40, 0.3}, {40, 4.31}});
  corridor.walls.push_back({{-40, 2.3}, {40, 6.31}});
  const Pair pair = map_twice(corridor, {{0, 3.3, 0}, {2, 3.4, 0}}, {{0.5, 3.3, 0}, {2.5, 3.4, 0}});
  const LoopMatch small = search(pair, pair.truth, {0.3, 0.3, radians(3)});
  EXPECT_EQ(refusal(small), "degenerate") << said(small);
  EXPECT_LT(small.roundness, 0.01);
  EXPECT_TRUE(refusal(search(pair, pair.truth, kWide)).has_value());
}

TEST(LoopSearch, RefusesOtherRooms) {
  DrawnWorld left, right;
  left.add_box(0.007, 0.011, 6.013, 4.009);
  left.add_box(1.0, 2.6, 1.9, 3.3);
  left.walls.push_back({{4, 0}, {4, 1.5}});
  right.add_box(0.007, 0.011, 5.013, 5.209);
  right.add_box(3.0, 1.0, 3.6, 3.0);
  right.walls.push_back({{0, 3.8}, {1.9, 3.8}});
  const std::vector<Pose2> way = {{2.5, 1.8, 0}, {2.4, 2.2, 0}};
  const FinishedMap target = finished_map(left, {.world_T_robot = way});
  const FinishedMap source = finished_map(right, {.world_T_robot = way});
  for (const SearchWindow& window : {SearchWindow{0.3, 0.3, radians(3)}, kMedium, kWide}) {
    const LoopMatch match = find_loop(MaxPyramid(target), target, source, {}, window);
    EXPECT_TRUE(refusal(match).has_value()) << said(match);
  }
}

TEST(LoopSearch, FindsARoomWhoseFurnitureWasMoved) {
  DrawnWorld before = two_rooms(), after = two_rooms();
  after.add_box(5.0, 3.2, 5.6, 3.8);
  after.add_box(0.3, 1.1, 0.8, 1.5);
  before.add_box(3.4, 3.9, 4.1, 4.4);
  const Pose2 truth = kFirstWay.front().inverse() * kSecondWay.front();
  const FinishedMap target = finished_map(before, {.world_T_robot = kFirstWay});
  const FinishedMap source = finished_map(after, {.world_T_robot = kSecondWay});
  const LoopMatch match =
      find_loop(MaxPyramid(target), target, source, truth * Pose2{0.6, -0.4, 0.1}, kMedium);
  EXPECT_EQ(refusal(match), std::nullopt) << said(match);
  EXPECT_THAT(match.target_T_source, PoseNear(truth, 0.005, radians(0.1)));
  EXPECT_GT(match.contradicted + match.contradicted_back, 0.02) << "and says that something differs";
}

TEST(LoopSearch, RunsOutOfBudgetWithoutAClosure) {
  const Pair pair = map_twice(two_rooms(), kFirstWay, kSecondWay);
  LoopSearchConfig config;
  config.search.max_nodes = 100;
  const LoopMatch match = search(pair, pair.truth, kWide, config);
  EXPECT_TRUE(match.out_of_budget);
  EXPECT_LE(match.nodes, 100);
  EXPECT_EQ(refusal(match), "out of budget");
}

TEST(LoopSearch, TakesEmptyMapsAndGuessesThatAreNone) {
  const Pair pair = map_twice(two_rooms(), kFirstWay, kSecondWay);
  const FinishedMap empty;
  const MaxPyramid pyramid(pair.target), nothing(empty);
  EXPECT_EQ(refusal(find_loop(nothing, empty, pair.source, {}, kMedium)), "nothing found");
  EXPECT_EQ(refusal(find_loop(pyramid, pair.target, empty, {}, kMedium)), "nothing found");
  EXPECT_EQ(refusal(find_loop(nothing, empty, empty, {}, kMedium)), "nothing found");
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Pose2& guess : {Pose2{nan, 0, 0}, Pose2{0, inf, 0}, Pose2{0, 0, nan}, Pose2{1e12, 0, 0}}) {
    EXPECT_EQ(refusal(find_loop(pyramid, pair.target, pair.source, guess, kMedium)), "nothing found");
  }
  EXPECT_EQ(refusal(find_loop(pyramid, pair.target, pair.source, {}, {nan, 1, 1})), "nothing found");
  EXPECT_TRUE(refusal(find_loop(pyramid, pair.target, pair.source, {200, 200, 0}, kMedium)).has_value());
}

TEST(LoopRules, NameTheReason) {
  LoopMatch good;
  good.found = true;
  good.points = 500;
  good.overlap = 0.8, good.score = 0.7, good.matched = 0.9, good.roundness = 0.5;
  EXPECT_EQ(refusal(good), std::nullopt);
  const auto with = [&](auto change) {
    LoopMatch m = good;
    change(m);
    return refusal(m).value_or("");
  };
  EXPECT_EQ(with([](LoopMatch& m) { m.found = false; }), "nothing found");
  EXPECT_EQ(with([](LoopMatch& m) { m.overlap = 0.1; }), "too little overlap");
  EXPECT_EQ(with([](LoopMatch& m) { m.points = 60; }), "too little overlap");
  EXPECT_EQ(with([](LoopMatch& m) { m.score = 0.2; }), "poor score");
  EXPECT_EQ(with([](LoopMatch& m) { m.matched = 0.4; }), "poor score");
  EXPECT_EQ(with([](LoopMatch& m) { m.contradicted = 0.5; }), "contradicted");
  EXPECT_EQ(with([](LoopMatch& m) { m.contradicted_back = 0.5; }), "contradicted");
  EXPECT_EQ(with([](LoopMatch& m) { m.runner_up = 0.95; }), "ambiguous");
  EXPECT_EQ(with([](LoopMatch& m) { m.roundness = 0.001; }), "degenerate");
  EXPECT_EQ(with([](LoopMatch& m) { m.out_of_budget = true; }), "out of budget");
}

}  // namespace
}  // namespace dynslam
