// SPDX-License-Identifier: MIT
#include "tools/jitter/trajectory_error.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support_matchers.h"

namespace dynslam::jitter {
namespace {

const Pose2 kRef_T_map{-7.0, 3.0, 2.5};

/// A bent way, a pose each tenth of a second.
std::vector<StampedPose> bent_way(int poses = 200) {
  std::vector<StampedPose> way;
  for (int i = 0; i < poses; ++i)
    way.push_back({time_at_s(5 + 0.1 * i), {0.1 * i, std::sin(0.1 * i), wrap_angle(0.03 * i)}});
  return way;
}

std::vector<StampedPose> moved(const Pose2& by, std::vector<StampedPose> way) {
  for (StampedPose& p : way) p.map_T_robot = by * p.map_T_robot;
  return way;
}

/// A straight way along x at 1 m/s with poses at these times.
std::vector<StampedPose> straight_way(const std::vector<double>& times_s) {
  std::vector<StampedPose> way;
  for (const double t : times_s) way.push_back({time_at_s(t), {t, 0, 0}});
  return way;
}

TEST(AbsoluteError, IsNoneForTheSameWayInAnotherFrame) {
  EXPECT_NEAR(absolute_error_m(bent_way(), moved(kRef_T_map, bent_way())), 0.0, 1e-12);
}

TEST(AbsoluteError, IsTheRootOfTheMeanSquare) {
  // Four corners of a square, pulled out by 0.2 m each: no turn or shift makes up for it, and scale is none
  // to be had.
  const std::vector<StampedPose> corners = {{time_at_s(1), {1, 0, 0}},
                                            {time_at_s(2), {0, 1, 0}},
                                            {time_at_s(3), {-1, 0, 0}},
                                            {time_at_s(4), {0, -1, 0}}};
  std::vector<StampedPose> pulled = corners;
  for (StampedPose& p : pulled) {
    p.map_T_robot.x *= 1.2;
    p.map_T_robot.y *= 1.2;
  }
  EXPECT_NEAR(absolute_error_m(moved(kRef_T_map, pulled), corners), 0.2, 1e-12);
  pulled = corners;
  pulled[0].map_T_robot.x = 1.4, pulled[2].map_T_robot.x = -1.4;
  EXPECT_NEAR(absolute_error_m(pulled, corners), 0.4 * std::sqrt(0.5), 1e-12);
}

TEST(AbsoluteError, DoesNotAskForOrder) {
  std::vector<StampedPose> estimate = bent_way(), reference = moved(kRef_T_map, bent_way());
  std::reverse(estimate.begin(), estimate.end());
  std::rotate(reference.begin(), reference.begin() + 50, reference.end());
  EXPECT_NEAR(absolute_error_m(estimate, reference), 0.0, 1e-12);
}

TEST(AbsoluteError, TakesTheLastOfEqualStamps) {
  std::vector<StampedPose> estimate = bent_way();
  estimate.insert(estimate.begin(), {estimate[20].stamp, {1e3, 0, 0}});
  EXPECT_NEAR(absolute_error_m(estimate, bent_way()), 0.0, 1e-12);
}

TEST(AbsoluteError, RefusesWaysThatShareNoTime) {
  std::vector<StampedPose> later = bent_way();
  for (StampedPose& p : later) p.stamp += std::chrono::hours(1);
  EXPECT_THROW(absolute_error_m(later, bent_way()), InputError);
  EXPECT_THROW(absolute_error_m({}, bent_way()), InputError);
  EXPECT_THROW(absolute_error_m(bent_way(), {}), InputError);
  EXPECT_THROW(absolute_error_m(bent_way(), bent_way(1)), InputError);
}

TEST(Alignment, FindsTheMotionBetweenTheFrames) {
  EXPECT_THAT(alignment(pair_up(bent_way(), moved(kRef_T_map, bent_way()))),
              PoseNear(kRef_T_map, 1e-12, 1e-12));
}

TEST(Alignment, GoesByHeadingWhereTheRobotStands) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < 10; ++i) {
    const Pose2 turning{1, 2, 0.5 * i};
    pairs.push_back(
        {kRef_T_map * turning, {turning.x + (i % 2 == 0 ? 0.01 : -0.01), turning.y, turning.yaw}});
  }
  EXPECT_THAT(alignment(pairs), PoseNear(kRef_T_map, 1e-9, 1e-9));
}

TEST(PairUp, InterpolatesBetweenNeighbours) {
  const auto pairs = pair_up(straight_way({1.0, 3.5}), straight_way({1.8, 2.0}));
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_THAT(pairs[0].map_T_robot, PoseNear(Pose2{1.8, 0, 0}, 1e-9, 1e-9));
  EXPECT_THAT(pairs[1].map_T_robot, PoseNear(Pose2{2.0, 0, 0}, 1e-9, 1e-9));
}

TEST(PairUp, TakesAPoseWithinAMillisecondAsItIs) {
  const auto pairs = pair_up(straight_way({1.0, 2.0}), straight_way({1.0009, 1.9991, 1.0011}));
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_EQ(pairs[0].map_T_robot.x, 1.0);
  EXPECT_NEAR(pairs[1].map_T_robot.x, 1.0011, 1e-9);
  EXPECT_EQ(pairs[2].map_T_robot.x, 2.0);
}

TEST(PairUp, DoesNotBridgeALongGap) {
  const auto pairs = pair_up(straight_way({1.0, 5.0}), straight_way({1.08, 3.0, 4.95}));
  ASSERT_EQ(pairs.size(), 2U) << "only near its ends";
  EXPECT_EQ(pairs[0].map_T_robot.x, 1.0);
  EXPECT_EQ(pairs[1].map_T_robot.x, 5.0);
}

TEST(PairUp, ReachesATenthOfASecondBeyondTheEnds) {
  const auto pairs = pair_up(straight_way({1.0, 2.0}), straight_way({0.85, 0.95, 2.05, 2.15}));
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].map_T_robot.x, 1.0);
  EXPECT_EQ(pairs[1].map_T_robot.x, 2.0);
}

}  // namespace
}  // namespace dynslam::jitter
