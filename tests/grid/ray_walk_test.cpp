// SPDX-License-Identifier: MIT
#include "grid/ray_walk.h"

#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dynslam {
namespace {

using ::testing::ElementsAre;

std::vector<CellIndex> cells_between(Eigen::Vector2d a, Eigen::Vector2d b, double cell = 1.0) {
  std::vector<CellIndex> cells;
  walk_ray(a, b, cell, [&](CellIndex c) { cells.push_back(c); });
  return cells;
}

TEST(RayWalk, GoesStraightAndOblique) {
  EXPECT_THAT(cells_between({0.5, 0.5}, {3.5, 0.5}),
              ElementsAre(CellIndex{0, 0}, CellIndex{1, 0}, CellIndex{2, 0}, CellIndex{3, 0}));
  EXPECT_THAT(cells_between({0.5, 0.5}, {2.5, 1.7}),
              ElementsAre(CellIndex{0, 0}, CellIndex{1, 0}, CellIndex{1, 1}, CellIndex{2, 1}));
}

TEST(RayWalk, CrossesTheOriginIntoNegativeCells) {
  EXPECT_THAT(cells_between({0.5, 0.5}, {-1.5, 0.5}),
              ElementsAre(CellIndex{0, 0}, CellIndex{-1, 0}, CellIndex{-2, 0}));
}

TEST(RayWalk, StaysInOneCell) {
  EXPECT_THAT(cells_between({0.2, 0.2}, {0.8, 0.9}), ElementsAre(CellIndex{0, 0}));
}

TEST(RayWalk, IsConnectedAndEndsWhereItShould) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-5, 5);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d a{any(random), any(random)}, b{any(random), any(random)};
    const auto cells = cells_between(a, b, 0.05);
    EXPECT_EQ(cells.front(), cell_at(a, 0.05));
    EXPECT_EQ(cells.back(), cell_at(b, 0.05));
    for (std::size_t k = 1; k < cells.size(); ++k) {
      EXPECT_EQ(std::abs(cells[k].x - cells[k - 1].x) + std::abs(cells[k].y - cells[k - 1].y), 1);
      // Every cell touches the segment: its centre is within half a diagonal of it.
      const Eigen::Vector2d centre = cell_centre(cells[k], 0.05);
      const Eigen::Vector2d along = (b - a).normalized();
      const double off = std::abs(along.x() * (centre - a).y() - along.y() * (centre - a).x());
      EXPECT_LE(off, 0.05 * 0.7072);
    }
  }
}

}  // namespace
}  // namespace dynslam
