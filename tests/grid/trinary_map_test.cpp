// SPDX-License-Identifier: MIT
#include "grid/trinary_map.h"

#include <gtest/gtest.h>

#include "grid/drawn_map.h"

namespace dynslam {
namespace {

TEST(TrinaryMap, OfNothingIsNothing) {
  const TrinaryMap map = trinary_map(ChunkedGrid(0.05).snapshot());
  EXPECT_EQ(map.width, 0);
  EXPECT_EQ(map.height, 0);
  EXPECT_DOUBLE_EQ(map.cell_size_m, 0.05);
}

TEST(TrinaryMap, IsCroppedToWhatIsKnown) {
  ChunkedGrid grid(0.05);
  draw(grid, {"#. ", " .#"}, {-2, 63});
  const TrinaryMap map = trinary_map(grid.snapshot());
  EXPECT_DOUBLE_EQ(map.cell_size_m, 0.05);
  EXPECT_EQ(map.origin, (CellIndex{-2, 63}));
  ASSERT_EQ(map.width, 3);
  ASSERT_EQ(map.height, 2);
  EXPECT_EQ(map.at(0, 0), CellState::kUnknown);
  EXPECT_EQ(map.at(1, 0), CellState::kFree);
  EXPECT_EQ(map.at(2, 0), CellState::kOccupied);
  EXPECT_EQ(map.at(0, 1), CellState::kOccupied);
  EXPECT_EQ(map.at(2, 1), CellState::kUnknown);
}

TEST(TrinaryMap, CoarserKeepsWalls) {
  ChunkedGrid grid(0.05);
  draw(grid, {".. .", ". #.", "....", "    "}, {-3, -2});
  const TrinaryMap map = coarser(trinary_map(grid.snapshot()));
  EXPECT_DOUBLE_EQ(map.cell_size_m, 0.1);
  EXPECT_EQ(map.origin, (CellIndex{-2, -1}));
  ASSERT_EQ(map.width, 3);
  ASSERT_EQ(map.height, 2);
  EXPECT_EQ(map.at(0, 0), CellState::kFree);
  EXPECT_EQ(map.at(1, 1), CellState::kOccupied);
  EXPECT_EQ(map.at(2, 1), CellState::kFree);
  EXPECT_EQ(coarser(TrinaryMap{}).width, 0);
}

}  // namespace
}  // namespace dynslam
