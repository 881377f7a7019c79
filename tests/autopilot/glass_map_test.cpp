// SPDX-License-Identifier: MIT
#include "autopilot/glass_map.h"

#include <vector>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

using std::chrono::minutes;
const Time kNow = Time(minutes(100));
const Vector2 kFarAway(9.0, 9.0);

bool see(GlassMap& glass, const Segment& pane, Time now = kNow, const Vector2& robot = kFarAway) {
  return glass.see(now, std::vector<Segment>{pane}, robot);
}

TEST(GlassMap, PutsTogetherWhatIsOnOneLine) {
  GlassMap glass;
  EXPECT_TRUE(see(glass, {{0, 1}, {0.5, 1}}));
  EXPECT_FALSE(see(glass, {{0.1, 1.01}, {0.5, 1.0}})) << "nothing new";
  EXPECT_TRUE(see(glass, {{1.3, 1.02}, {0.6, 1.0}}));
  EXPECT_EQ(glass.outlines_map().size(), 1U);
  EXPECT_TRUE(see(glass, {{3.0, 1.0}, {3.5, 1.0}})) << "a doorway is between";
  EXPECT_TRUE(see(glass, {{0.5, 1.0}, {0.5, 1.5}})) << "round the corner";
  EXPECT_EQ(glass.outlines_map().size(), 3U);
}

TEST(GlassMap, WhereTheRobotDroveThroughThereIsNone) {
  GlassMap glass;
  see(glass, {{0, 1}, {2, 1}});
  EXPECT_FALSE(glass.see(kNow, {}, {1.0, 0.8})) << "beside it";
  EXPECT_TRUE(glass.see(kNow, {}, {1.0, 0.95}));
  EXPECT_TRUE(glass.outlines_map().empty());
}

TEST(GlassMap, DoubtsAndForgets) {
  GlassMap glass;
  EXPECT_FALSE(glass.doubt());
  EXPECT_FALSE(glass.trust());
  see(glass, {{0, 1}, {2, 1}});
  EXPECT_TRUE(glass.doubt());
  EXPECT_TRUE(glass.outlines_map().empty());
  EXPECT_FALSE(glass.doubt());
  EXPECT_TRUE(glass.trust());
  EXPECT_EQ(glass.outlines_map().size(), 1U);
  EXPECT_FALSE(glass.see(kNow + minutes(29), {}, kFarAway));
  EXPECT_TRUE(glass.see(kNow + minutes(31), {}, kFarAway));
  EXPECT_TRUE(glass.outlines_map().empty());
}

TEST(GlassMap, WhatIsSeenAgainIsDoubtedNoMore) {
  GlassMap glass;
  see(glass, {{0, 1}, {2, 1}});
  see(glass, {{5, 1}, {6, 1}});
  EXPECT_TRUE(glass.doubt());
  EXPECT_TRUE(see(glass, {{1.0, 1}, {1.2, 1}})) << "a part of it";
  ASSERT_EQ(glass.outlines_map().size(), 1U) << "all of it, and nothing else";
  EXPECT_LT(glass.outlines_map()[0][0].x(), 2.1);
  EXPECT_FALSE(glass.doubt()) << "once is enough";
  EXPECT_TRUE(glass.trust());
  EXPECT_EQ(glass.outlines_map().size(), 2U);
  EXPECT_TRUE(glass.doubt());
  EXPECT_TRUE(glass.outlines_map().empty());
}

}  // namespace
}  // namespace dynslam
