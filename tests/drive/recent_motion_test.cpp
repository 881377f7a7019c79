// SPDX-License-Identifier: MIT
#include "drive/recent_motion.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support_matchers.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;

Time at_ms(int ms) { return Time(milliseconds(ms)); }

ImuSample heading(int ms, double yaw_rad) {
  return {at_ms(ms), Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()))};
}

TEST(RecentMotion, IsNoneBeforeAnythingIsKnown) {
  EXPECT_THAT(RecentMotion().between(at_ms(0), at_ms(1000)), PoseNear(Pose2{}, 0, 0));
}

TEST(RecentMotion, AddsUpWhatWasCommanded) {
  RecentMotion motion;
  motion.add(at_ms(0), {1, 0}, {});
  motion.add(at_ms(100), {0, kPi / 2 / 0.1}, {});
  motion.add(at_ms(200), {2, 0}, {});
  EXPECT_THAT(motion.between(at_ms(0), at_ms(300)), PoseNear(Pose2{0.1, 0.2, kPi / 2}, 1e-9, 1e-9));
  EXPECT_THAT(motion.between(at_ms(50), at_ms(150)), PoseNear(Pose2{0.05, 0, kPi / 4}, 1e-9, 1e-9));
  EXPECT_THAT(motion.between(at_ms(250), at_ms(500)), PoseNear(Pose2{0.5, 0, 0}, 1e-9, 1e-9));
  EXPECT_THAT(motion.between(at_ms(300), at_ms(200)), PoseNear(Pose2{}, 0, 0));
  EXPECT_FALSE(motion.knows_turns());
}

TEST(RecentMotion, DrivesAlongArcs) {
  RecentMotion motion;
  motion.add(at_ms(0), {1, kPi}, {});
  EXPECT_THAT(motion.between(at_ms(0), at_ms(1000)), PoseNear(Pose2{0, 2 / kPi, kPi}, 1e-9, 1e-9));
}

TEST(RecentMotion, BelievesTheImuOfTurnsAndOutlivesASpike) {
  RecentMotion motion;
  for (int i = 0; i <= 20; ++i) {
    const double spike = i == 15 ? 0.2 : 0.0;
    motion.add(at_ms(20 * i), {0, 3}, heading(20 * i, 0.02 * i + spike));  // it slips: 1 of 3 rad/s
    if (i <= 5) continue;
    EXPECT_TRUE(motion.knows_turns());
    EXPECT_NEAR(motion.between(at_ms(100), at_ms(20 * i + 20)).yaw, 0.02 * (i - 4), 1e-6) << i;
  }
}

TEST(RecentMotion, GoesByCommandsWhenTheImuFallsSilent) {
  RecentMotion motion;
  for (int i = 0; i <= 20; ++i) motion.add(at_ms(20 * i), {0, 3}, heading(20 * std::min(i, 10), 0));
  EXPECT_FALSE(motion.knows_turns());
  EXPECT_NEAR(motion.between(at_ms(340), at_ms(400)).yaw, 0.18, 1e-6);
}

TEST(RecentMotion, ForgetsWhenTheClockRunsBackwards) {
  RecentMotion motion;
  motion.add(at_ms(1000), {1, 0}, {});
  motion.add(at_ms(500), {0, 0}, {});
  EXPECT_THAT(motion.between(at_ms(400), at_ms(1200)), PoseNear(Pose2{}, 0, 0));
}

}  // namespace
}  // namespace dynslam
