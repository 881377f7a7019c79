// SPDX-License-Identifier: MIT
#include "slam/motion_model.h"

#include <algorithm>
#include <cmath>

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

/// As `driven`, at 0.5 rad/s; from then on the map does not say where the robot is.
MotionModel driven_blindly(double until_s, bool has_wheels) {
  MotionModel motion = driven(0.5);
  for (int i = 0; has_wheels && i <= 100; ++i)
    motion.add(OdometrySample{time_at_s(0.1 * i), {0.02 * i, 0, 0}});
  for (double t_s = 1.1; t_s < until_s + 0.01; t_s += 0.1)
    motion.fix(time_at_s(t_s), motion.expect(time_at_s(t_s)).map_T_robot, false);
  return motion;
}
double turned_in_next_step(const MotionModel& motion) {
  return turn(motion.last_pose().yaw, motion.expect(motion.last_time() + from_seconds(0.1)).map_T_robot.yaw);
}

TEST(MotionModel, AVelocityThatNothingMeasuresDoesNotLast) {
  EXPECT_NEAR(turned_in_next_step(driven_blindly(1.5, false)), 0.05, 1e-6);
  EXPECT_NEAR(turned_in_next_step(driven_blindly(2.5, false)), 0.0, 1e-6);
  const MotionModel stands = driven_blindly(4.0, false);
  EXPECT_LT((stands.last_pose().translation() - driven_blindly(2.5, false).last_pose().translation()).norm(),
            1e-6);
  EXPECT_NEAR(driven_blindly(4.0, true).motion_around(time_at_s(4.0))(time_at_s(4.05)).x, 0.01, 0.001)
      << "the wheels measure it";
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

TEST(MotionModel, DoubtingTheWheelsFollowsThemAllTheSameAfterLongerThanAVelocityLasts) {
  MotionModel motion = driven(0);
  for (const double t_s : {1.0, 4.0}) motion.add(OdometrySample{time_at_s(t_s), {t_s, 0, 0.1 * t_s}});
  const MatchPrior prior = motion.expect_doubting_wheels(time_at_s(4.0));
  EXPECT_THAT(prior.map_T_robot,
              PoseNear(Pose2{0.5, 0, 0} * Pose2{3 * std::cos(0.1), -3 * std::sin(0.1), 0.3}, 1e-6, 1e-6));
  EXPECT_GT(prior.sigma_xy_m, motion.expect(time_at_s(4.0)).sigma_xy_m);
  EXPECT_GT(prior.sigma_yaw_rad, 0.2);
  for (int i = 0; i <= 400; ++i) motion.add(heading(0.01 * i, -0.002 * i));
  EXPECT_NEAR(motion.expect_doubting_wheels(time_at_s(4.0)).map_T_robot.yaw, -0.6, 1e-6) << "by the IMU";
}

/// A robot that drives along x at 0.5 m/s, a fix and a wheel count every 0.1 s. From 1.0 to 1.8 s the count
/// stands still, at 1.9 s it has caught up. Fixes until 1.8 s, each as `believed` has it.
template <class Believed>
MotionModel with_wheels_that_stand_still(Believed&& believed) {
  MotionModel motion;
  for (int i = 0; i <= 19; ++i) {
    const double way_m = 0.05 * (i > 10 && i < 19 ? 10 : i);
    motion.add(OdometrySample{time_at_s(0.1 * i), Pose2{3, -2, 1} * Pose2{way_m, 0, 0}});
    if (i < 19) motion.fix(time_at_s(0.1 * i), {believed(i), 0, 0});
  }
  return motion;
}
double as_it_was(int i) { return 0.05 * i; }
double as_the_wheels_say(int i) { return 0.05 * std::min(i, 10); }

TEST(MotionModel, TheLongerWayIsRightWhetherOrNotTheRobotWasFollowedMeanwhile) {
  for (const auto& believed : {as_it_was, as_the_wheels_say}) {
    const MotionModel motion = with_wheels_that_stand_still(believed);
    EXPECT_TRUE(motion.wheels_leap(time_at_s(1.9)));
    const auto prior = motion.expect_by_longer_way(time_at_s(1.9));
    ASSERT_TRUE(prior);
    EXPECT_THAT(prior->map_T_robot, PoseNear(Pose2{0.95, 0, 0}, 0.001, 1e-6));
    EXPECT_LT(prior->sigma_xy_m, 0.2);
  }
  EXPECT_NEAR(with_wheels_that_stand_still(as_it_was).expect(time_at_s(1.9)).map_T_robot.x, 0.9 + 0.45, 1e-6)
      << "and the shorter is not";
}

TEST(MotionModel, TheLongerWayTakesTheTurnFromTheImu) {
  MotionModel motion = with_wheels_that_stand_still(as_it_was);
  for (int i = 0; i <= 200; ++i) motion.add(heading(0.01 * i, 0.5 + 0.01 * i));
  EXPECT_NEAR(motion.expect_by_longer_way(time_at_s(1.9))->map_T_robot.yaw, 0.1, 1e-6);
}

TEST(MotionModel, ThereIsNoLongerWayWithoutWheelsOrFixes) {
  EXPECT_FALSE(driven(0).expect_by_longer_way(time_at_s(1.1)));
  EXPECT_FALSE(MotionModel().expect_by_longer_way(time_at_s(1.1)));
  MotionModel late = driven(0);
  late.add(OdometrySample{time_at_s(0.8), {}});
  EXPECT_FALSE(late.expect_by_longer_way(time_at_s(0.85))) << "the wheels do not reach back that far";
}

TEST(MotionModel, TellsALeapOfTheWheelsFromDriving) {
  const auto leaps = [](const Pose2& step, double dt_s) {
    MotionModel motion = driven(0);
    motion.add(OdometrySample{time_at_s(1.0), {7, 7, 1}});
    motion.add(OdometrySample{time_at_s(1.0 + dt_s), Pose2{7, 7, 1} * step});
    return motion.wheels_leap(time_at_s(1.0 + dt_s));
  };
  EXPECT_FALSE(leaps({0.05, 0, 0}, 0.1)) << "on at 0.5 m/s";
  EXPECT_FALSE(leaps({0.15, 0, 0}, 0.1)) << "a kick";
  EXPECT_FALSE(leaps({0.0, 0, 0}, 0.1)) << "a sudden halt";
  EXPECT_FALSE(leaps({0.05, 0, 1.0}, 0.1)) << "a turn is none";
  EXPECT_TRUE(leaps({0.3, 0, 0}, 0.1));
  EXPECT_TRUE(leaps({-0.2, 0, 0}, 0.1));
  EXPECT_TRUE(leaps({0.05, 0.2, 0}, 0.1)) << "sideways";
  EXPECT_FALSE(leaps({0.3, 0, 0}, 0.5)) << "in half a second, it may";
  EXPECT_FALSE(leaps({3.0, 0, 0}, 2.0)) << "after so long, no velocity lasts";
  EXPECT_FALSE(driven(0).wheels_leap(time_at_s(1.1))) << "without wheels";
}

TEST(MotionModel, TellsALeapOfTheRobotFromDriving) {
  const auto leaps = [](const Pose2& step, double dt_s) {
    return driven(0).is_leap(time_at_s(1.0 + dt_s), Pose2{0.5, 0, 0} * step);
  };
  EXPECT_FALSE(leaps({0.05, 0, 0}, 0.1));
  EXPECT_FALSE(leaps({0.0, 0, 0}, 0.1)) << "a sudden halt";
  EXPECT_FALSE(leaps({0.05, 0, 0.2}, 0.1));
  EXPECT_TRUE(leaps({0.05, 0, 0.5}, 0.1));
  EXPECT_TRUE(leaps({0.05, 0.3, 0}, 0.1));
  EXPECT_FALSE(leaps({1.0, 0, 1.0}, 0.6)) << "in so long, it may";
  EXPECT_FALSE(leaps({3.0, 0, 0}, 2.0)) << "after so long, no velocity lasts";
  EXPECT_FALSE(MotionModel().is_leap(time_at_s(1), {5, 5, 0})) << "from nowhere";
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
