// SPDX-License-Identifier: MIT
#include "slam/scan_matcher.h"

#include <random>

#include <gtest/gtest.h>

#include "grid/free_space.h"
#include "slam/drawn_world.h"
#include "slam/local_map.h"
#include "slam/passes.h"
#include "support_matchers.h"

namespace dynslam {
namespace {

constexpr double kCell = 0.02;

/// A scan of the two rooms as points in the robot's frame, in cells.
std::vector<MatchPoint> points_from(const Pose2& world_T_robot, double cell = kCell, double noise_m = 0.0) {
  std::mt19937 random(8);
  const Scan scan = look(
      two_rooms(), {}, [&](Time) { return world_T_robot; }, {.turn_s = 0, .noise_m = noise_m}, random);
  std::vector<MatchPoint> points;
  for (const Beam& b : scan.beams) {
    points.push_back({static_cast<float>(b.range_m * std::cos(b.angle_rad) / cell),
                      static_cast<float>(b.range_m * std::sin(b.angle_rad) / cell), 1.0F});
  }
  return points;
}

/// The two rooms as a map that `frame` has moved and turned.
ChunkedGrid map_of_rooms(const Pose2& frame, double cell = kCell) {
  ChunkedGrid grid(cell, 4096, kLocalMapRule);
  FreeSpace free_space;
  std::mt19937 random(9);
  const Pose2 places[] = {{2, 2.5, 0}, {6, 2.5, 0.3}, {3, 3, 2}, {4.5, 2.4, 1}};
  for (int i = 0; i < 40; ++i) {
    const Pose2 at = places[i % 4];
    const Scan scan = look(
        two_rooms(), {}, [&](Time) { return at; }, {.beams = 1000, .turn_s = 0, .noise_m = 0.01}, random);
    const CorrectedScan corrected = egomotion_pass(scan, clamp_pass(scan, {}), [](Time) { return Pose2{}; });
    grid.apply(free_space.trace(frame * at, corrected.ends_lidar, 0.02, cell));
  }
  return grid;
}

TEST(ScanMatcher, FindsThePoseInAnyFrame) {
  const Pose2 truth{2.4, 2.1, 0.7};
  for (const Pose2& frame : {Pose2{}, Pose2{-3.21, 0.77, 0}, Pose2{1.13, -2.4, 2.2}}) {
    const ChunkedGrid map = map_of_rooms(frame);
    ScanMatcher matcher;
    const MatchPrior prior{frame * truth * Pose2{0.05, -0.04, 0.01}};
    const MatchResult result = matcher.match(map, points_from(truth), prior);
    EXPECT_THAT(result.map_T_robot, PoseNear(frame * truth, 0.004, 0.002));
    EXPECT_GT(result.matched, 0.95);
    EXPECT_GT(result.known, 0.95);
    EXPECT_GT(result.score, 0.3);
  }
}

TEST(ScanMatcher, FindsRandomPosesFromNarrowAndWidePriors) {
  const ChunkedGrid map = map_of_rooms({});
  ScanMatcher matcher;
  std::mt19937 random(10);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const bool wide = trial % 2 == 0;
    const Pose2 truth{2.2 + 0.5 * unit(random), 2.2 + 0.5 * unit(random), 3 * unit(random)};
    const double xy = wide ? 0.12 : 0.03, yaw = wide ? 0.1 : 0.01;
    const Pose2 off{2 * xy * unit(random), 2 * xy * unit(random), 2 * yaw * unit(random)};
    const MatchPrior prior{{truth.x + off.x, truth.y + off.y, truth.yaw + off.yaw}, xy, yaw};
    const MatchResult result = matcher.match(map, points_from(truth, kCell, 0.01), prior);
    EXPECT_THAT(result.map_T_robot, PoseNear(truth, 0.01, 0.005)) << trial;
  }
}

TEST(ScanMatcher, WorksWithCoarseCells) {
  const Pose2 truth{2.4, 2.1, -0.7};
  const ChunkedGrid map = map_of_rooms({}, 0.05);
  ScanMatcher matcher;
  const MatchResult result =
      matcher.match(map, points_from(truth, 0.05), {truth * Pose2{0.1, 0.05, 0.03}, 0.05, 0.02});
  EXPECT_THAT(result.map_T_robot, PoseNear(truth, 0.015, 0.006));
}

TEST(ScanMatcher, LetsThePriorDecideWhereTheMapCannot) {
  // A corridor without ends: the walls say nothing of the way along it.
  ChunkedGrid corridor(kCell);
  std::vector<MatchPoint> points;
  for (int x = -600; x <= 600; ++x) {
    for (int k = 0; k < 25; ++k) {
      corridor.add_hit({x, 50});
      corridor.add_hit({x, -51});
    }
    if (std::abs(x) < 200)
      points.push_back({static_cast<float>(x), 50.5F, 1}),
          points.push_back({static_cast<float>(x), -50.5F, 1});
  }
  ScanMatcher matcher;
  const MatchResult result = matcher.match(corridor, points, {{1.0, 0.05, 0.0}, 0.1, 0.02});
  EXPECT_NEAR(result.map_T_robot.x, 1.0, 0.02);
  EXPECT_NEAR(result.map_T_robot.y, 0.0, 0.004);
  EXPECT_GT(result.covariance(0, 0), 50 * result.covariance(1, 1)) << "and the covariance says so";
}

TEST(ScanMatcher, SaysWhenTheMapDoesNotAnswer) {
  const ChunkedGrid map = map_of_rooms({});
  ScanMatcher matcher;
  const MatchResult elsewhere = matcher.match(map, points_from({2.4, 2.1, 0.7}), {{200, 200, 0}});
  EXPECT_EQ(elsewhere.known, 0.0);
  EXPECT_EQ(elsewhere.score, 0.0);
  EXPECT_THAT(elsewhere.map_T_robot, PoseNear(Pose2{200, 200, 0}, 1e-6, 1e-6));
  std::vector<MatchPoint> nonsense;
  std::mt19937 random(2);
  for (int i = 0; i < 300; ++i)
    nonsense.push_back({static_cast<float>(random() % 60), static_cast<float>(random() % 60), 1});
  EXPECT_LT(matcher.match(map, nonsense, {{2.4, 2.1, 0}}).matched, 0.4);
}

TEST(ScanMatcher, AnswersThePriorWithNothingToGoBy) {
  ScanMatcher matcher;
  const Pose2 expected{1, 2, 3};
  EXPECT_THAT(matcher.match(ChunkedGrid(kCell), points_from({2, 2, 0}), {expected}).map_T_robot,
              PoseNear(expected, 1e-9, 1e-9));
  const MatchResult blind = matcher.match(map_of_rooms({}), {}, {expected});
  EXPECT_THAT(blind.map_T_robot, PoseNear(expected, 1e-9, 1e-9));
  EXPECT_EQ(blind.score, 0.0);
}

}  // namespace
}  // namespace dynslam
