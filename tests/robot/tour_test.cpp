// SPDX-License-Identifier: MIT
#include "robot/tour.h"

#include <cmath>

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

const Verdict kHeld{Motion::kHold, "a person"};

/// Stands at a pose from one time to another.
Twist stand_at(Tour& tour, double from_s, double to_s, const PoseEstimate& pose, const Verdict& verdict) {
  Twist last;
  for (double s = from_s; s < to_s; s += 0.1) last = tour.next(time_at_s(s), pose, verdict);
  return last;
}

TEST(Tour, DrivesBackFromWhatIsInTheWayAndTriesAgain) {
  Tour tour({{1, 0}, {3, 0}}, {.blocked_s = 5.0});
  tour.next(time_at_s(0), at(0.95, 0, 0), kGo);
  EXPECT_GT(stand_at(tour, 0.1, 5, at(1.5, 0, 0), kHeld).v_mps, 0.0);
  const Twist back = stand_at(tour, 5, 6, at(1.5, 0, 0), kGo);
  EXPECT_EQ(back.v_mps, 0.0);
  EXPECT_GT(std::abs(back.w_radps), 1.0) << "it turns round, to the point before";
  const Twist again = stand_at(tour, 6, 6.3, at(1.1, 0, 0), kGo);
  EXPECT_GT(again.v_mps, 0.3) << "and comes again";
  EXPECT_EQ(tour.skipped(), 0U);
}

TEST(Tour, LeavesOutWhatItCannotReach) {
  Tour tour({{3, 0}, {0, 3}}, {.blocked_s = 5.0, .tries = 2});
  const PoseEstimate here = at(1, 0, 0);
  stand_at(tour, 0, 5.2, here, kHeld);      // once
  stand_at(tour, 5.2, 10.4, here, kHeld);   // nor is there a way back
  stand_at(tour, 10.4, 15.3, here, kHeld);  // twice
  EXPECT_EQ(tour.skipped(), 0U);
  stand_at(tour, 15.3, 16, here, kHeld);
  EXPECT_EQ(tour.skipped(), 1U);
  EXPECT_FALSE(tour.done());
}

}  // namespace
}  // namespace dynslam
