// SPDX-License-Identifier: MIT
#include "slam/motion_model.h"

#include <gtest/gtest.h>

#include "support_matchers.h"

namespace dynslam {
namespace {

ImuSample heading(double t_s, double yaw_rad) {
  return {time_at_s(t_s), Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()))};
}

/// Fixes every 0.1 s up to t = 1 s along x at 0.5 m/s, turning at `yaw_rate`.
MotionModel driven(double yaw_rate) {
  MotionModel motion;
  for (int i = 0; i <= 10; ++i) motion.fix(time_at_s(0.1 * i), {0.05 * i, 0, 0.1 * i * yaw_rate});
  return motion;
}

TEST(MotionModel, CarriesOnAtTheLastVelocityWithNothingElse) {
  const MatchPrior soon = driven(0).expect(time_at_s(1.1));
  EXPECT_THAT(soon.map_T_robot, PoseNear(Pose2{0.55, 0, 0}, 0.002, 1e-6));
  EXPECT_LT(soon.sigma_xy_m, 0.05);
  const MatchPrior late = driven(0).expect(time_at_s(11));
  EXPECT_LT(late.map_T_robot.x, 1.1) << "not for ever";
  EXPECT_GT(late.sigma_xy_m, 10 * soon.sigma_xy_m);
}

TEST(MotionModel, TakesTheTurnFromTheImu) {
  MotionModel motion = driven(0);
  for (int i = 0; i <= 120; ++i) motion.add(heading(0.01 * i, 2.0 + 0.008 * i));
  const MatchPrior prior = motion.expect(time_at_s(1.1));
  EXPECT_NEAR(prior.map_T_robot.yaw, 0.08, 1e-6);
  EXPECT_LT(prior.sigma_yaw_rad, driven(0).expect(time_at_s(1.1)).sigma_yaw_rad);
  EXPECT_NEAR(motion.yaw_rate(time_at_s(1.0)), 0.8, 1e-6);
}

TEST(MotionModel, TakesTheWayFromTheWheels) {
  MotionModel motion = driven(0);
  motion.add(OdometrySample{time_at_s(1.0), {7, 7, 1.0}});
  motion.add(OdometrySample{time_at_s(1.1), {7 + 0.2 * std::cos(1.0), 7 + 0.2 * std::sin(1.0), 1.1}});
  EXPECT_THAT(motion.expect(time_at_s(1.1)).map_T_robot, PoseNear(Pose2{0.7, 0, 0.1}, 1e-6, 1e-6));
  EXPECT_THAT(motion.expect_doubting_wheels(time_at_s(1.1)).map_T_robot,
              PoseNear(Pose2{0.55, 0, 0}, 0.002, 1e-6));
}

TEST(MotionModel, DoesNotBelieveWheelsThatLeap) {
  MotionModel motion = driven(0);
  motion.add(OdometrySample{time_at_s(1.0), {0, 0, 0}});
  motion.add(OdometrySample{time_at_s(1.1), {30, 0, 0}});
  EXPECT_THAT(motion.expect(time_at_s(1.1)).map_T_robot, PoseNear(Pose2{0.55, 0, 0}, 0.002, 1e-6));
}

TEST(MotionModel, KnowsTheMotionInsideAScan) {
  MotionModel motion = driven(0.5);
  const MotionInScan around = motion.motion_around(time_at_s(1.0));
  EXPECT_THAT(around(time_at_s(1.0)), PoseNear(Pose2{}, 1e-9, 1e-9));
  EXPECT_NEAR(around(time_at_s(1.04)).yaw, 0.02, 1e-6);
  EXPECT_NEAR(around(time_at_s(0.96)).yaw, -0.02, 1e-6);
  EXPECT_NEAR(around(time_at_s(1.04)).translation().norm(), 0.02, 0.001);
}

TEST(MotionModel, LooksAroundWhenTheClockWasSetBack) {
  EXPECT_GT(driven(0).expect(time_at_s(-100)).sigma_xy_m, 0.3);
}

}  // namespace
}  // namespace dynslam
