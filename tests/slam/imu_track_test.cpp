// SPDX-License-Identifier: MIT
#include "slam/imu_track.h"

#include <gtest/gtest.h>

namespace dynslam {
namespace {

ImuSample heading(double t_s, double yaw_rad) {
  return {time_at_s(t_s), Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()))};
}

TEST(ImuTrack, SaysNothingBeforeItKnowsAnything) {
  ImuTrack track;
  EXPECT_FALSE(track.heading_at(time_at_s(0)));
  track.add(heading(0, 1));
  EXPECT_FALSE(track.heading_at(time_at_s(0))) << "one sample has no rate";
}

TEST(ImuTrack, InterpolatesBetweenSamplesAndCarriesOnALittle) {
  ImuTrack track;
  for (int i = 0; i <= 10; ++i) track.add(heading(0.01 * i, 0.02 * i));
  EXPECT_NEAR(*track.heading_at(time_at_s(0.055)), 0.11, 1e-9);
  EXPECT_NEAR(*track.heading_at(time_at_s(0.0)), 0.0, 1e-9);
  EXPECT_NEAR(*track.heading_at(time_at_s(0.15)), 0.30, 1e-9);
  EXPECT_FALSE(track.heading_at(time_at_s(0.2)));
  EXPECT_FALSE(track.heading_at(time_at_s(-0.01)));
}

TEST(ImuTrack, IsContinuousOverFullTurns) {
  ImuTrack track;
  for (int i = 0; i <= 300; ++i) track.add(heading(0.01 * i, 0.05 * i));
  EXPECT_NEAR(*track.heading_at(time_at_s(3.0)) - *track.heading_at(time_at_s(0.0)), 15.0, 1e-9);
}

TEST(ImuTrack, SmoothsASinglePeakAndNothingElse) {
  ImuTrack track;
  for (int i = 0; i <= 20; ++i) track.add(heading(0.01 * i, 0.02 * i + (i == 10 ? 0.3 : 0.0)));
  EXPECT_EQ(track.spikes_smoothed(), 1U);
  for (int i = 0; i <= 20; ++i) EXPECT_NEAR(*track.heading_at(time_at_s(0.01 * i)), 0.02 * i, 1e-9) << i;
}

TEST(ImuTrack, TheNewestSampleMayStillBeAPeak) {
  ImuTrack track;
  track.add(heading(0.0, 0.0));
  EXPECT_EQ(track.settled(), time_at_s(0.0));
  track.add(heading(0.01, 0.0));
  track.add(heading(0.02, 0.3));
  EXPECT_EQ(track.settled(), time_at_s(0.01));
  EXPECT_GT(*track.heading_at(time_at_s(0.015)), 0.1);
  track.add(heading(0.03, 0.0));
  EXPECT_EQ(track.settled(), time_at_s(0.02));
  EXPECT_NEAR(*track.heading_at(time_at_s(0.015)), 0.0, 1e-9);
}

TEST(ImuTrack, KeepsAStepAndAFastTurn) {
  ImuTrack track;
  for (int i = 0; i <= 20; ++i) track.add(heading(0.01 * i, i < 10 ? 0.0 : 0.3));
  EXPECT_EQ(track.spikes_smoothed(), 0U);
  ImuTrack fast;
  for (int i = 0; i <= 20; ++i) fast.add(heading(0.01 * i, 0.08 * i));
  EXPECT_EQ(fast.spikes_smoothed(), 0U);
}

TEST(ImuTrack, DropsWhatGoesBackOrStandsStillInTime) {
  ImuTrack track;
  track.add(heading(1.0, 0));
  track.add(heading(1.0, 9));
  track.add(heading(0.5, 9));
  track.add(heading(1.01, 0.01));
  EXPECT_EQ(track.out_of_order(), 2U);
  EXPECT_NEAR(*track.heading_at(time_at_s(1.005)), 0.005, 1e-9);
}

TEST(ImuTrack, SaysNothingAcrossAGap) {
  ImuTrack track;
  track.add(heading(0.00, 0));
  track.add(heading(0.01, 0));
  track.add(heading(0.60, 2));
  track.add(heading(0.61, 2));
  EXPECT_FALSE(track.heading_at(time_at_s(0.3)));
  EXPECT_TRUE(track.heading_at(time_at_s(0.605)));
}

TEST(ImuTrack, TakesTheUsualTiltForLevel) {
  const auto tilted = [](double t_s, double pitch) {
    return ImuSample{time_at_s(t_s),
                     Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                         Eigen::Quaterniond(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()))};
  };
  ImuTrack track;
  EXPECT_FALSE(track.tilt_at(time_at_s(0)));
  EXPECT_EQ(track.tilt_rate(time_at_s(0)), 0.0);
  for (int i = 0; i < 3000; ++i) track.add(tilted(0.01 * i, 0.05));  // mounted askew by three degrees
  EXPECT_LT(track.tilt_at(time_at_s(29.9))->angularDistance(Eigen::Quaterniond::Identity()), 1e-3);
  for (int i = 3000; i < 3020; ++i)
    track.add(tilted(0.01 * i, 0.05 + 0.005 * (i - 2999)));  // over a doorstep
  EXPECT_NEAR(track.tilt_at(time_at_s(30.19))->angularDistance(Eigen::Quaterniond::Identity()), 0.1, 0.01);
  EXPECT_NEAR(track.tilt_rate(time_at_s(30.1)), 0.5, 0.1);
}

TEST(ImuTrack, ForgetsWhatIsOld) {
  ImuTrack track;
  for (int i = 0; i <= 2000; ++i) track.add(heading(0.01 * i, 0));
  EXPECT_FALSE(track.heading_at(time_at_s(10)));
  EXPECT_TRUE(track.heading_at(time_at_s(17)));
}

}  // namespace
}  // namespace dynslam
