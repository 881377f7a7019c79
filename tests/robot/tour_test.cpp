// SPDX-License-Identifier: MIT
#include "robot/tour.h"

#include <gtest/gtest.h>

namespace dynslam {
namespace {

const Verdict kGo{Motion::kGo, {}};

PoseEstimate at(double x, double y, double yaw) {
  PoseEstimate estimate;
  estimate.map_T_robot = {x, y, yaw};
  estimate.quality = 1.0;
  return estimate;
}

TEST(Tour, DrivesStraightToWhatLiesAhead) {
  Tour tour({{3, 0}});
  const Twist t = tour.next(time_at_s(0), at(0, 0, 0), kGo);
  EXPECT_GT(t.v_mps, 0.3);
  EXPECT_NEAR(t.w_radps, 0.0, 1e-9);
}

TEST(Tour, TurnsOnTheSpotToWhatLiesBehind) {
  Tour tour({{-3, 0.1}});
  const Twist t = tour.next(time_at_s(0), at(0, 0, 0), kGo);
  EXPECT_EQ(t.v_mps, 0.0);
  EXPECT_GT(t.w_radps, 0.5);
}

TEST(Tour, GoesFromPointToPointAndEnds) {
  Tour tour({{1, 0}, {1, 1}});
  EXPECT_GT(tour.next(time_at_s(0), at(0.9, 0, 0), kGo).w_radps, 0.5) << "already on the way to the second";
  EXPECT_EQ(tour.next(time_at_s(1), at(1, 0.95, 1.5), kGo), Twist{});
  EXPECT_TRUE(tour.done());
  EXPECT_EQ(tour.reached(), 2U);
}

TEST(Tour, LetsGoWhileItIsStopped) {
  Tour tour({{3, 0}});
  EXPECT_EQ(tour.next(time_at_s(0), at(0, 0, 0), {Motion::kStop, "no lidar data"}), Twist{});
}

TEST(Tour, GivesUpWhatLastsTooLong) {
  Tour tour({{3, 0}}, {.patience_s = 10.0});
  const Verdict stop{Motion::kStop, "no lidar data"};
  tour.next(time_at_s(0), at(0, 0, 0), stop);
  tour.next(time_at_s(9), at(0, 0, 0), stop);
  EXPECT_GT(tour.next(time_at_s(9.5), at(0, 0, 0), kGo).v_mps, 0.0) << "it may go on";
  tour.next(time_at_s(10), at(0, 0, 0), stop);
  tour.next(time_at_s(20), at(0, 0, 0), stop);
  EXPECT_FALSE(tour.gave_up());
  tour.next(time_at_s(20.1), at(0, 0, 0), stop);
  EXPECT_EQ(tour.gave_up(), "no lidar data");
  EXPECT_EQ(tour.next(time_at_s(21), at(0, 0, 0), kGo), Twist{});
}

TEST(Tour, LooksRoundWhenLost) {
  Tour tour({{3, 0}}, {.patience_s = 10.0});
  PoseEstimate lost = at(0, 0, 0);
  lost.lost = true;
  const Twist t = tour.next(time_at_s(0), lost, kGo);
  EXPECT_EQ(t.v_mps, 0.0);
  EXPECT_GT(t.w_radps, 0.1);
  EXPECT_EQ(tour.next(time_at_s(11), lost, kGo), Twist{});
  EXPECT_EQ(tour.gave_up(), "lost");
}

TEST(Tour, LeavesOutWhatItCannotReach) {
  Tour tour({{3, 0}, {0, 3}}, {.blocked_skip_s = 5.0});
  tour.next(time_at_s(0), at(0, 0, 0), kGo);
  for (double s = 0.1; s < 4.9; s += 0.1) tour.next(time_at_s(s), at(0.01, 0, 0), {Motion::kHold, "a wall"});
  EXPECT_EQ(tour.skipped(), 0U);
  tour.next(time_at_s(5.2), at(0.01, 0, 0), {Motion::kHold, "a wall"});
  EXPECT_EQ(tour.skipped(), 1U);
  EXPECT_FALSE(tour.done());
}

}  // namespace
}  // namespace dynslam
