// SPDX-License-Identifier: MIT
#include "autopilot/felt_obstacles.h"

#include <vector>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

constexpr double kRadius_m = 0.2;
const Time kNow = Time(std::chrono::seconds(100));

Vector2 middle_of(const std::vector<Vector2>& outline) {
  Vector2 sum = Vector2::Zero();
  for (const Vector2& p : outline) sum += p;
  return sum / static_cast<double>(outline.size());
}

/// Where the only thing that counts is from where the robot touched it, facing along x.
Vector2 only_one(const FeltObstacles& felt) {
  const auto outlines = felt.outlines_map();
  EXPECT_EQ(outlines.size(), 1U);
  return outlines.empty() ? Vector2::Zero() : middle_of(outlines.front());
}

TEST(FeltObstacles, AreGuessedInTheMiddleThenLeftThenRight) {
  FeltObstacles felt;
  felt.touched(kNow, {}, {0.3, 0.1}, kRadius_m);
  EXPECT_NEAR(only_one(felt).y(), 0.0, 1e-9);
  EXPECT_GT(only_one(felt).x(), kRadius_m);
  EXPECT_TRUE(felt.doubt());
  EXPECT_GT(only_one(felt).y(), 0.1);
  EXPECT_TRUE(felt.doubt());
  EXPECT_LT(only_one(felt).y(), -0.1);
  EXPECT_FALSE(felt.trust()) << "the guess stands";
  EXPECT_TRUE(felt.doubt());
  EXPECT_TRUE(felt.outlines_map().empty());
  EXPECT_FALSE(felt.doubt());
  EXPECT_TRUE(felt.trust());
  EXPECT_NEAR(only_one(felt).y(), 0.0, 1e-9);
}

TEST(FeltObstacles, TheLastOneIsDoubtedFirst) {
  FeltObstacles felt;
  felt.touched(kNow, {}, {0.3, 0.0}, kRadius_m);
  felt.touched(kNow, {5.0, 0.0, 0.0}, {-0.3, 0.0}, kRadius_m);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(felt.doubt());
  EXPECT_NEAR(only_one(felt).x(), kRadius_m, 0.05);
}

TEST(FeltObstacles, NearToEachOtherAreOneThing) {
  for (const double apart_m : {0.6, 1.2}) {
    FeltObstacles felt;
    felt.touched(kNow, {0.0, 0.0, 0.0}, {0.3, 0.0}, kRadius_m);
    felt.touched(kNow, {0.0, apart_m, 0.0}, {0.3, 0.0}, kRadius_m);
    const auto outlines = felt.outlines_map();
    ASSERT_EQ(outlines.size(), apart_m < 1.0 ? 3U : 2U);
    if (outlines.size() < 3) continue;
    EXPECT_EQ(outlines.back().size(), 4U);
    EXPECT_NEAR(middle_of(outlines.back()).y(), 0.5 * apart_m, 1e-9);
    EXPECT_NEAR(middle_of(outlines.back()).x(), kRadius_m, 0.05);
  }
}

TEST(FeltObstacles, AreLargerEachTimeTheyAreTouched) {
  FeltObstacles felt;
  double before_m = 0.0;
  for (int i = 0; i < 3; ++i) {
    felt.touched(kNow, {0.0, 0.1 * i, 0.0}, {0.3, 0.0}, kRadius_m);
    const auto outline = felt.outlines_map().front();
    const double radius_m = (outline.front() - middle_of(outline)).norm();
    EXPECT_GT(radius_m, before_m);
    before_m = radius_m;
  }
  for (int i = 0; i < 20; ++i) felt.touched(kNow, {}, {0.3, 0.0}, kRadius_m);
  const auto outline = felt.outlines_map().front();
  EXPECT_LT((outline.front() - middle_of(outline)).norm(), 0.5);
}

TEST(FeltObstacles, OfATurnCountsButLeavesNothing) {
  FeltObstacles felt;
  felt.touched(kNow, {}, {0.0, 1.0}, kRadius_m);
  EXPECT_TRUE(felt.outlines_map().empty());
  EXPECT_FALSE(felt.doubt());
  EXPECT_FALSE(felt.trust());
  EXPECT_EQ(felt.count_since(kNow), 1U);
  EXPECT_EQ(felt.count_since(kNow + std::chrono::milliseconds(1)), 0U);
}

TEST(FeltObstacles, AreForgottenInTime) {
  FeltObstacles felt;
  felt.touched(kNow, {}, {0.3, 0.0}, kRadius_m);
  EXPECT_FALSE(felt.forget(kNow + std::chrono::minutes(9)));
  EXPECT_TRUE(felt.forget(kNow + std::chrono::minutes(11)));
  EXPECT_TRUE(felt.outlines_map().empty());
}

}  // namespace
}  // namespace dynslam
