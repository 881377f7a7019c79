// SPDX-License-Identifier: MIT
#include "slam/odometry_track.h"

#include <gtest/gtest.h>

#include "support_matchers.h"

namespace dynslam {
namespace {

TEST(OdometryTrack, InterpolatesAndHoldsTheNewestForAMoment) {
  OdometryTrack track;
  EXPECT_FALSE(track.pose_at(time_at_s(0)));
  track.add({time_at_s(0), {0, 0, 0}});
  track.add({time_at_s(1), {2, 0, 0.4}});
  EXPECT_THAT(*track.pose_at(time_at_s(0.25)), PoseNear(Pose2{0.5, 0, 0.1}, 1e-9, 1e-9));
  EXPECT_THAT(*track.pose_at(time_at_s(1.05)), PoseNear(Pose2{2, 0, 0.4}, 1e-9, 1e-9));
  EXPECT_FALSE(track.pose_at(time_at_s(1.2)));
  EXPECT_FALSE(track.pose_at(time_at_s(-0.1)));
}

TEST(OdometryTrack, TakesTheLaterOfTwoWithOneStampAndNoneFromThePast) {
  OdometryTrack track;
  track.add({time_at_s(1), {1, 0, 0}});
  track.add({time_at_s(1), {2, 0, 0}});
  track.add({time_at_s(0.5), {9, 9, 9}});
  EXPECT_THAT(*track.pose_at(time_at_s(1)), PoseNear(Pose2{2, 0, 0}, 1e-9, 1e-9));
  EXPECT_EQ(track.out_of_order(), 1U);
}

TEST(OdometryTrack, KeepsAWayToGoFromInSparseLogs) {
  OdometryTrack track;
  for (int i = 0; i < 5; ++i) track.add({time_at_s(60.0 * i), {1.0 * i, 0, 0}});
  EXPECT_THAT(*track.pose_at(time_at_s(210)), PoseNear(Pose2{3.5, 0, 0}, 1e-9, 1e-9));
  EXPECT_FALSE(track.pose_at(time_at_s(30)));
}

}  // namespace
}  // namespace dynslam
