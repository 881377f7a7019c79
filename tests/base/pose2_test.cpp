// SPDX-License-Identifier: MIT
#include "base/pose2.h"

#include <random>

#include <gtest/gtest.h>

#include "support_matchers.h"

namespace dynslam {
namespace {

TEST(Angles, WrapKeepsTheAngleAndFitsTheCircle) {
  EXPECT_DOUBLE_EQ(wrap_angle(0.5), 0.5);
  EXPECT_NEAR(wrap_angle(0.5 + 3 * kTwoPi), 0.5, 1e-12);
  EXPECT_NEAR(wrap_angle(-0.5 - 5 * kTwoPi), -0.5, 1e-12);
  EXPECT_NEAR(std::abs(wrap_angle(kPi)), kPi, 1e-12);
  EXPECT_TRUE(std::isnan(wrap_angle(INFINITY)));
}

TEST(Angles, TurnIsTheShortWayRound) {
  EXPECT_NEAR(turn(radians(170), radians(-170)), radians(20), 1e-12);
  EXPECT_NEAR(turn(radians(-170), radians(170)), radians(-20), 1e-12);
}

TEST(Pose2, MovesPointsFromOneFrameToTheOther) {
  const Pose2 map_T_robot{1, 2, radians(90)};
  const Vector2 ahead_robot(3, 0);
  const Vector2 ahead_map = map_T_robot * ahead_robot;
  EXPECT_NEAR(ahead_map.x(), 1, 1e-12);
  EXPECT_NEAR(ahead_map.y(), 5, 1e-12);
}

TEST(Pose2, ChainsAndInverts) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-4, 4);
  for (int i = 0; i < 200; ++i) {
    const Pose2 a{any(random), any(random), any(random)}, b{any(random), any(random), any(random)};
    const Vector2 p{any(random), any(random)};
    EXPECT_NEAR((((a * b) * p) - (a * (b * p))).norm(), 0, 1e-12);
    EXPECT_THAT(a * a.inverse(), PoseNear(Pose2{}, 1e-12, 1e-12));
    EXPECT_THAT(a.inverse() * (a * b), PoseNear(b, 1e-12, 1e-12));
  }
}

TEST(Pose2, InterpolatesAcrossTheSeamOfTheCircle) {
  const Pose2 a{0, 0, radians(170)}, b{2, 4, radians(-170)};
  EXPECT_THAT(interpolate(a, b, 0.5), PoseNear(Pose2{1, 2, kPi}, 1e-12, 1e-9));
  EXPECT_THAT(interpolate(a, b, 1.5), PoseNear(Pose2{3, 6, radians(-160)}, 1e-12, 1e-9));
}

TEST(Pose2, KnowsWhatIsNotFinite) {
  EXPECT_TRUE(is_finite(Pose2{1, 2, 3}));
  EXPECT_FALSE(is_finite(Pose2{NAN, 2, 3}));
  EXPECT_FALSE(is_finite(Pose2{1, INFINITY, 3}));
  EXPECT_FALSE(is_finite(Pose2{1, 2, NAN}));
}

}  // namespace
}  // namespace dynslam
