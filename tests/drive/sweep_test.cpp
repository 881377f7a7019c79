// SPDX-License-Identifier: MIT
#include "drive/sweep.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/pose2.h"

namespace dynslam {
namespace {

// A body of 28 x 24 cm with the default margins: 24 cm from the middle to the leading edge when driving
// straight, 17 cm to the trailing one, 15 cm to the sides.
constexpr double kFront = 0.24, kSide = 0.15;

double contact(const Twist& twist, double x, double y) { return Sweep({}, {}, twist).contact_s(x, y); }

TEST(Sweep, StraightAheadItIsTheWayOverTheSpeed) {
  EXPECT_NEAR(contact({0.5, 0}, 1.24, 0), 2.0, 1e-9);
  EXPECT_NEAR(contact({0.5, 0}, 1.24, kSide - 0.001), 2.0, 1e-9);
  EXPECT_TRUE(std::isinf(contact({0.5, 0}, 1.24, kSide + 0.001)));
  EXPECT_TRUE(std::isinf(contact({0.5, 0}, -1.24, 0))) << "behind";
  EXPECT_NEAR(contact({-0.5, 0}, -1.24, 0), 2.0, 1e-9);
  EXPECT_TRUE(std::isinf(contact({-0.5, 0}, 1.24, 0)));
}

TEST(Sweep, OnTheSpotOnlyWhatTheCornersReach) {
  const double corner = std::hypot(0.17, kSide);
  EXPECT_TRUE(std::isinf(contact({0, 1}, corner + 0.001, 0)));
  const double meets = std::acos(0.17 / (corner - 0.001)) - 0.0;  // where the circle leaves the front edge
  const double from_ahead = contact({0, 1}, corner - 0.001, 0);
  EXPECT_NEAR(from_ahead, std::asin(kSide / corner) - 0.0, 0.02);
  EXPECT_GE(from_ahead + 1e-9, meets) << "the right corner comes first, turning left";
  EXPECT_NEAR(contact({0, -1}, corner - 0.001, 0), from_ahead, 1e-9);
  EXPECT_NEAR(contact({0, 2}, corner - 0.001, 0), from_ahead / 2, 1e-9);
}

TEST(Sweep, AnArcTurnsAwayFromAWallAhead) {
  EXPECT_FALSE(std::isinf(contact({0.5, 0.5}, 0.9, 0.3)));
  EXPECT_TRUE(std::isinf(contact({0.5, 3.0}, 0.9, 0.0)));
}

TEST(Sweep, WithinTheMarginOnlyWhatComesNearerCounts) {
  EXPECT_LT(contact({0.5, 0}, 0.2, 0), 0.01) << "6 cm ahead: not further";
  EXPECT_TRUE(std::isinf(contact({-0.5, 0}, 0.2, 0))) << "but back";
  EXPECT_TRUE(std::isinf(contact({0.5, 0}, 0.0, 0.13))) << "1 cm beside: along it";
  EXPECT_TRUE(std::isinf(contact({-0.5, 0}, 0.0, 0.13)));
  EXPECT_LT(contact({0, 1}, 0.10, 0.13), 0.05) << "turning brings a corner nearer, one way";
  EXPECT_GT(contact({0, -1}, 0.10, 0.13), 0.5);
}

/// The same by driving in small steps.
double contact_by_steps(const Twist& twist, const BodyMargin& margin, double x, double y, double most_s) {
  const BodyConfig body;
  const double forward_share =
      std::abs(twist.v_mps) / (std::abs(twist.v_mps) + std::abs(twist.w_radps) * body.radius_m());
  const double leading = margin.side_m + forward_share * (margin.leading_m - margin.side_m);
  const double front = body.half_length_m() + (twist.v_mps >= 0 ? leading : margin.side_m);
  const double rear = body.half_length_m() + (twist.v_mps >= 0 ? margin.side_m : leading);
  const double side = body.half_width_m() + margin.side_m;
  const double step_s = 0.0005;
  Pose2 start_T_now;
  for (double t = 0; t < most_s; t += step_s) {
    const Vector2 p = start_T_now.inverse() * Vector2(x, y);
    if (p.x() <= front && p.x() >= -rear && std::abs(p.y()) <= side) return t;
    const double half = 0.5 * twist.w_radps * step_s;
    start_T_now = start_T_now * Pose2{twist.v_mps * step_s * std::cos(half),
                                      twist.v_mps * step_s * std::sin(half), 2 * half};
  }
  return most_s;
}

TEST(Sweep, AgreesWithDrivingInSmallSteps) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> v(-1, 1), w(-3, 3), at(-0.8, 0.8);
  int met = 0;
  for (int i = 0; i < 800; ++i) {
    const Twist twist{i % 5 == 0 ? 0.0 : v(random), i % 7 == 0 ? 0.0 : w(random)};
    const double x = at(random), y = at(random);
    if (!is_moving(twist) || std::max(std::abs(x) - kFront, std::abs(y) - kSide) < 0.0) continue;
    const double most_s = twist.w_radps == 0 ? 2.0 : std::min(2.0, kTwoPi / std::abs(twist.w_radps) - 0.01);
    const double slow = contact_by_steps(twist, {}, x, y, most_s);
    // Where the box is only grazed, half a step decides whether it is met.
    double nearest = 1e9;
    for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {1e-3, 0.0}, {-1e-3, 0.0}, {0.0, 1e-3}, {0.0, -1e-3}})
      nearest = std::min(nearest, std::abs(std::min(most_s, contact(twist, x + dx, y + dy)) - slow));
    EXPECT_LT(nearest, 0.003) << twist.v_mps << " " << twist.w_radps << " to " << x << ", " << y;
    met += slow < most_s ? 1 : 0;
  }
  EXPECT_GT(met, 50);
}

TEST(Sweep, IsTheSameInAMirror) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> v(-1, 1), w(-3, 3), at(-0.6, 0.6);
  for (int i = 0; i < 1000; ++i) {
    const Twist t{v(random), w(random)};
    const double x = at(random), y = at(random);
    const double here = contact(t, x, y);
    EXPECT_EQ(here, contact({t.v_mps, -t.w_radps}, x, -y));
    EXPECT_EQ(here, contact({-t.v_mps, -t.w_radps}, -x, y));
  }
}

TEST(Sweep, AlmostStraightIsLikeStraight) {
  for (const double y : {-0.14, 0.0, 0.1}) {
    const double straight = contact({1, 0}, 1.5, y);
    for (const double w : {1e-12, 1e-6, 0.9e-3, 1.1e-3, 2e-3})
      EXPECT_NEAR(contact({1, w}, 1.5, y), straight, 0.002) << w;
  }
}

}  // namespace
}  // namespace dynslam
