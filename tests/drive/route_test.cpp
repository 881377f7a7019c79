// SPDX-License-Identifier: MIT
#include "drive/route.h"

#include <gtest/gtest.h>

namespace dynslam {
namespace {

/// 4 m ahead, 3 m to the left, 4 m back.
const Route kHairpin({{0, 0}, {0, 0}, {4, 0}, {4, 3}, {4, 3}, {0, 3}});

TEST(Route, TellsPlacesByTheWay) {
  EXPECT_EQ(kHairpin.length_m(), 11.0);
  EXPECT_EQ(kHairpin.at(-1), Vector2(0, 0));
  EXPECT_EQ(kHairpin.at(4), Vector2(4, 0));
  EXPECT_EQ(kHairpin.at(5), Vector2(4, 1));
  EXPECT_EQ(kHairpin.at(99), Vector2(0, 3));
  EXPECT_EQ(kHairpin.end(), Vector2(0, 3));
}

TEST(Route, FindsTheNearestPlaceWithinAWindow) {
  EXPECT_EQ(kHairpin.nearest({1, 2}, 0, 11).along_m, 10.0);
  EXPECT_EQ(kHairpin.nearest({1, 2}, 0, 11).away_m, 1.0);
  EXPECT_EQ(kHairpin.nearest({1, 2}, 0, 3).along_m, 1.0);
  EXPECT_EQ(kHairpin.nearest({1, 2}, 2, 3).along_m, 2.0);
  EXPECT_EQ(kHairpin.nearest({1, 2}, -5, -3).along_m, 0.0);
}

TEST(Route, AmongAboutEquallyNearPlacesTheFirst) {
  EXPECT_EQ(kHairpin.first_near({1, 1.53}).along_m, 1.0);
  EXPECT_EQ(kHairpin.first_near({1, 1.7}).along_m, 10.0);
}

TEST(Route, KnowsItsCorners) {
  const auto corners = kHairpin.corners(0, 11);
  ASSERT_EQ(corners.size(), 2U);
  EXPECT_EQ(corners[0].along_m, 4.0);
  EXPECT_NEAR(corners[1].turn_rad, kPi / 2, 1e-12);
  EXPECT_TRUE(kHairpin.corners(4, 7).empty());
}

TEST(Route, SightEndsWhereALineWouldCutACorner) {
  EXPECT_EQ(kHairpin.sight_m({0, 0}, 0, 0.2, 1.0, 0.1), 1.0);
  for (double x = 3.1; x < 4.0; x += 0.05) {
    const double sight = kHairpin.sight_m({x, 0}, x, 0.05, 1.0, 0.1);
    const double before = 4.0 - x, beyond = sight - before;
    EXPECT_GE(beyond, -0.05) << "the corner itself can be seen";
    if (beyond <= 0) continue;
    EXPECT_LE(before * beyond / std::hypot(before, beyond), 0.1 + 1e-9) << x;
  }
  EXPECT_EQ(kHairpin.sight_m({3.7, 0}, 3.7, 0.4, 1.0, 0.01), 0.4) << "but at least so far";
}

TEST(Route, APointAloneIsOne) {
  const Route point({{2, 1}});
  EXPECT_EQ(point.length_m(), 0.0);
  EXPECT_EQ(point.nearest({2, 0}, 0, 5).away_m, 1.0);
  EXPECT_EQ(point.first_near({2, 0}).along_m, 0.0);
  EXPECT_EQ(point.at(0.5), Vector2(2, 1));
  EXPECT_TRUE(Route().empty());
  EXPECT_TRUE(Route(std::vector<Vector2>()).empty());
}

}  // namespace
}  // namespace dynslam
