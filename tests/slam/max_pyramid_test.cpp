// SPDX-License-Identifier: MIT
#include "slam/max_pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

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
  for (const Pose2& frame : {Pose2{}, Pose2{-3.21, 0.77, 0}, Pose2{1.13, -2.4, 2.2}}) {
    const MaxPyramid pyramid(rooms(frame));
    const auto at = [&](double x, double y) { return pyramid.cell_of(frame * Vector2(x, y)); };
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
  CellBitmap cells;
  cells.reset({{0, 0}, {0, 0}});
  cells.set({50, 50});
  FinishedMap one_point;
  one_point.occupied = TiledBitmap(cells);
  one_point.cloud = {{std::numeric_limits<float>::quiet_NaN(), 0, 255}, {1.01F, 1.01F, 255}};
  const MaxPyramid one(one_point);
  EXPECT_GT(one.value(0, one.cell_of({1.01, 1.01})), 150);
}

/// Squares of cells of various densities, so that halves, quarters and eighths of them are sometimes free.
CellBitmap patchy(std::mt19937& random) {
  CellBitmap cells;
  cells.reset({{-2, -1}, {1, 1}});
  const CellIndex low = cells.first();
  for (int y = 0; y < cells.rows(); y += 8) {
    for (int x = 0; x < cells.words_per_row() * kChunkSide; x += 8) {
      const unsigned percent = std::array{0U, 40U, 70U, 85U, 100U}[random() % 5];
      for (int i = 0; i < 64; ++i) {
        if (random() % 100 < percent) cells.set({low.x + x + i % 8, low.y + y + i / 8});
      }
    }
  }
  return cells;
}

/// Whether most of a cell is free that is so many times twice as wide as the map's.
bool is_mostly_free(const CellBitmap& free, CellIndex c, int doublings) {
  if (doublings == 0) return free.test(c);
  int quarters = 0;
  for (int i = 0; i < 4; ++i)
    quarters += is_mostly_free(free, {2 * c.x + i % 2, 2 * c.y + i / 2}, doublings - 1) ? 1 : 0;
  return quarters >= 3;
}

TEST(MaxPyramid, ABaseCellIsFreeWhenMostOfItIs) {
  std::mt19937 random(8);
  const std::pair<double, int> cells_and_doublings[] = {{0.05, 1}, {0.02, 1}, {0.01, 2}, {0.005, 3}};
  for (const auto& [cell_m, doublings] : cells_and_doublings) {
    const CellBitmap free = patchy(random);
    FinishedMap map;
    map.cell_size_m = cell_m;
    map.free = TiledBitmap(free);
    const MaxPyramid pyramid(map);
    ASSERT_NEAR(pyramid.cell_size_m(), cell_m * (1 << doublings), 1e-12);
    const CellIndex low = free.first();
    int free_cells = 0;
    for (int y = (low.y >> doublings) - 1; y <= (low.y + free.rows()) >> doublings; ++y) {
      for (int x = (low.x >> doublings) - 1; x <= (low.x + 4 * kChunkSide) >> doublings; ++x) {
        const CellIndex base = pyramid.cell_of(cell_centre({x, y}, pyramid.cell_size_m()));
        const bool expected = is_mostly_free(free, {x, y}, doublings);
        ASSERT_EQ(pyramid.is_known(base), expected) << cell_m << ": " << x << " " << y;
        ASSERT_EQ(pyramid.is_clear(base), expected);
        ASSERT_EQ(pyramid.value(0, base), expected ? 0 : pyramid.unknown_worth());
        free_cells += expected ? 1 : 0;
      }
    }
    EXPECT_GT(free_cells, 100);
  }
}

}  // namespace
}  // namespace dynslam
