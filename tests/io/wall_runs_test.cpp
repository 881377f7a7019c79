// SPDX-License-Identifier: MIT
#include "io/wall_runs.h"

#include <gtest/gtest.h>

#include "io/drawn_map.h"

namespace dynslam {
namespace {

TEST(WallRuns, MergesCellsOfARow) {
  EXPECT_EQ(wall_runs(drawn_map({"##.#",  //
                                 " ## "}),
                      1),
            "M0 0.5h2M3 0.5h1M1 1.5h2");
}

TEST(WallRuns, LosesNoWallInBlocks) {
  EXPECT_EQ(wall_runs(drawn_map({"....#",  //
                                 ".....",  //
                                 "..#.."}),
                      2),
            "M2 0.5h1M1 1.5h1");
  EXPECT_EQ(wall_runs({}, 2), "");
}

TEST(WallsBox, HoldsAllOfAFewCells) {
  const auto box = walls_box_map(drawn_map({"... ",  //
                                            ".#..",  //
                                            "..#."},
                                           {-10, 5}, 0.5));
  EXPECT_EQ(box.min(), Eigen::Vector2d(-4.5, 2.5));
  EXPECT_EQ(box.max(), Eigen::Vector2d(-3.5, 3.5));
  EXPECT_TRUE(walls_box_map(drawn_map({".. "})).isEmpty());
  EXPECT_TRUE(walls_box_map({}).isEmpty());
}

TEST(WallsBox, DoesNotReachForAStrayCell) {
  TrinaryMap map;
  map.cell_size_m = 1.0;
  map.width = 2000;
  map.height = 10;
  map.cells.assign(20000, CellState::kFree);
  for (std::size_t row = 0; row < 10; ++row) {
    for (std::size_t column = 100; column < 200; ++column)
      map.cells[row * 2000 + column] = CellState::kOccupied;
  }
  map.cells[5 * 2000 + 1999] = CellState::kOccupied;
  EXPECT_EQ(walls_box_map(map).min(), Eigen::Vector2d(100, 0));
  EXPECT_EQ(walls_box_map(map).max(), Eigen::Vector2d(200, 10));
}

}  // namespace
}  // namespace dynslam
