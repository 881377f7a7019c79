// SPDX-License-Identifier: MIT
#include "robot/attitude_track.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

ImuSample sample_at(double t_s, double yaw_rad, double pitch_rad = 0.0, double roll_rad = 0.0) {
  return {time_at_s(t_s), Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                              Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX())};
}

TEST(AttitudeTrack, TellsAnglesAndTheTurn) {
  AttitudeTrack track;
  EXPECT_FALSE(track.update(time_at_s(1), std::nullopt));
  std::optional<Attitude> attitude;
  for (double t_s = 1.0; t_s < 12.0; t_s += 0.02)  // through half a turn several times
    attitude = track.update(time_at_s(t_s), sample_at(t_s, -2.5 * t_s, 0.1, -0.2));
  ASSERT_TRUE(attitude);
  EXPECT_NEAR(attitude->yaw_radps, -2.5, 1e-6);
  EXPECT_NEAR(attitude->pitch_rad, 0.1, 1e-9);
  EXPECT_NEAR(attitude->roll_rad, -0.2, 1e-9);
}

TEST(AttitudeTrack, TheSameSampleAgainAndSamplesOfOneTimeAreNoTurn) {
  AttitudeTrack track;
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(track.update(time_at_s(1 + 0.02 * i), sample_at(1.0, 0.1 * i))->yaw_radps, 0.0);
  EXPECT_NEAR(track.update(time_at_s(1.3), sample_at(1.25, 0.5))->yaw_radps, 2.0, 1e-6);
  EXPECT_NEAR(track.update(time_at_s(1.4), sample_at(1.25, 0.5))->yaw_radps, 2.0, 1e-6);
}

TEST(AttitudeTrack, IsNothingWhenTheImuIsSilentOrTalksNonsense) {
  AttitudeTrack track;
  EXPECT_TRUE(track.update(time_at_s(1), sample_at(1, 0.0)));
  ImuSample nonsense = sample_at(1.5, 0.0);
  nonsense.world_q_robot.coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(track.update(time_at_s(1.5), nonsense)) << "the one before counts";
  EXPECT_FALSE(track.update(time_at_s(2.5), nonsense));
  const auto back = track.update(time_at_s(9), sample_at(9, 3.0));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->yaw_radps, 0.0) << "nobody saw it turn";
}

TEST(AttitudeTrack, FollowsAClockThatWasSetBack) {
  AttitudeTrack track;
  EXPECT_TRUE(track.update(time_at_s(100), sample_at(100, 0.0)));
  EXPECT_EQ(track.update(time_at_s(5), sample_at(5, 1.0))->yaw_radps, 0.0);
  EXPECT_NEAR(track.update(time_at_s(5.5), sample_at(5.5, 1.5))->yaw_radps, 1.0, 1e-6);
}

}  // namespace
}  // namespace dynslam
