// SPDX-License-Identifier: MIT
#include "drive/back_off.h"

#include <gtest/gtest.h>

namespace dynslam {
namespace {

TEST(BackOff, DrivesTheSameArcBackSlowly) {
  BackOff back_off;
  back_off.note({0.5, 1.0});
  EXPECT_EQ(back_off.came(), (Twist{0.5, 1.0}));
  EXPECT_EQ(back_off.twist(), (Twist{-0.06, -0.12}));
}

TEST(BackOff, TurnsBackOnTheSpot) {
  BackOff back_off;
  back_off.note({0.0, -1.5});
  EXPECT_DOUBLE_EQ(back_off.twist().v_mps, 0.0);
  EXPECT_DOUBLE_EQ(back_off.twist().w_radps, 0.3);
}

TEST(BackOff, GoesByTheLastMotionNotByStandingStill) {
  BackOff back_off;
  back_off.note({-0.3, 0.0});
  back_off.note({});
  EXPECT_DOUBLE_EQ(back_off.twist().v_mps, 0.06);
}

TEST(BackOff, WhoNeverMovedBacksStraight) { EXPECT_EQ(BackOff().twist(), (Twist{-0.06, 0.0})); }

}  // namespace
}  // namespace dynslam
