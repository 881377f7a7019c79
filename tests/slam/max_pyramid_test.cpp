// SPDX-License-Identifier: MIT
#include "slam/max_pyramid.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "slam/drawn_finished_map.h"

namespace dynslam {
namespace {

FinishedMap rooms(const Pose2& drawn_T_world = {}) {
  return finished_map(two_rooms(), {.world_T_robot = {{2, 2.5, 0.4}, {3, 3, 0}, {5.5, 2.4, 0}},
                                    .drawn_T_world = drawn_T_world});
}

TEST(MaxPyramid, EveryCellBoundsTheBaseCellsThatItCovers) {
  const MaxPyramid pyramid(rooms());
  for (int level = 0; level < MaxPyramid::kLevels; ++level) {
    const int side = 1 << level;
    for (int y = -2; y <= pyramid.height() / side + 1; ++y) {
      for (int x = -2; x <= pyramid.width() / side + 1; ++x) {
        std::uint8_t most = 0;
        for (int v = y * side; v <= y * side + 2 * side - 2; ++v) {
          for (int u = x * side; u <= x * side + 2 * side - 2; ++u) {
            most = std::max(most, pyramid.value(0, {u, v}));
          }
        }
        ASSERT_EQ(pyramid.value(level, {x, y}), most) << level << " " << x << " " << y;
      }
    }
  }
}

TEST(MaxPyramid, LoadsStayInsideAndSeeUnknownSpaceBeyondTheMap) {
  const MaxPyramid pyramid(rooms());
  const std::int32_t far = 1 << 30;
  for (int level = 0; level < MaxPyramid::kLevels; ++level) {
    const int width = (pyramid.width() >> level) + 1, height = (pyramid.height() >> level) + 1;
    for (const CellIndex c : {CellIndex{-far, -far}, CellIndex{far, far}, CellIndex{-17, 0},
                              CellIndex{width, height}, CellIndex{0, far}}) {
      const std::uint8_t* at = pyramid.data(level) + pyramid.offset(level, c.x, c.y);
      for (int i = 0; i < MaxPyramid::kLanes; ++i) EXPECT_EQ(at[i], pyramid.unknown_worth());
    }
  }
}

TEST(MaxPyramid, KnowsSurfacesAndFreeSpaceInAnyFrame) {
  const Pose2 origin{2, 2.5, 0.4};
  for (const Pose2& frame : {Pose2{}, Pose2{-3.21, 0.77, 0}, Pose2{1.13, -2.4, 2.2}}) {
    const MaxPyramid pyramid(rooms(frame));
    const auto at = [&](double x, double y) { return pyramid.cell_of(origin.inverse() * Vector2(x, y)); };
    EXPECT_GT(pyramid.value(0, at(0.007, 2.0)), 180) << "on a wall";
    EXPECT_EQ(pyramid.value(0, at(3.5, 2.5)), 0) << "in free space";
    EXPECT_TRUE(pyramid.is_clear(at(3.5, 2.5)));
    EXPECT_TRUE(pyramid.is_known(at(0.007, 2.0)));
    EXPECT_FALSE(pyramid.is_clear(at(0.06, 2.0))) << "free, but next to a wall";
    EXPECT_FALSE(pyramid.is_known(at(1.5, 4.0))) << "inside a cupboard";
    EXPECT_EQ(pyramid.value(0, at(1.5, 4.0)), pyramid.unknown_worth());
  }
}

TEST(MaxPyramid, IsSmall) {
  DrawnWorld flat;
  flat.add_box(0, 0, 12, 9);
  const MaxPyramid pyramid(finished_map(flat, {.world_T_robot = {{6, 4.5, 0}}}));
  EXPECT_GE(pyramid.width(), 300);
  EXPECT_LT(pyramid.bytes(), 150'000U);
  RecordProperty("bytes", static_cast<int>(pyramid.bytes()));
}

TEST(MaxPyramid, TakesAnEmptyMapAndPointsThatAreNone) {
  FinishedMap empty;
  const MaxPyramid nothing(empty);
  EXPECT_EQ(nothing.width(), 0);
  EXPECT_EQ(nothing.value(4, {0, 0}), nothing.unknown_worth());
  EXPECT_FALSE(nothing.is_known({0, 0}));
  empty.cloud = {{std::numeric_limits<float>::quiet_NaN(), 0, 255}, {1, 1, 255}};
  const MaxPyramid one(empty);
  EXPECT_GT(one.value(0, one.cell_of({1, 1})), 150);
}

}  // namespace
}  // namespace dynslam
