// SPDX-License-Identifier: MIT
#include "grid/flood_fill.h"

#include <deque>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "grid/drawn_map.h"

namespace dynslam {
namespace {

std::set<CellIndex> brute_force(const CellBitmap& through, const std::vector<CellIndex>& seeds) {
  std::set<CellIndex> reached;
  std::deque<CellIndex> queue(seeds.begin(), seeds.end());
  while (!queue.empty()) {
    const CellIndex c = queue.front();
    queue.pop_front();
    if (!through.test(c) || !reached.insert(c).second) continue;
    for (const CellIndex d : {CellIndex{1, 0}, CellIndex{-1, 0}, CellIndex{0, 1}, CellIndex{0, -1}}) {
      queue.push_back({c.x + d.x, c.y + d.y});
    }
  }
  return reached;
}

TEST(FloodFill, StopsAtWallsAndGoesThroughDoors) {
  ChunkedGrid grid(0.02);
  const CellIndex low{-4, -3};  // the drawing straddles four chunks
  draw(grid,
       {"#########",  //
        "#...#...#",  //
        "#...#...#",  //
        "#...#...#",  //
        "#########"},
       low);
  const CellBitmap free = cells_in_state(grid.snapshot(), CellState::kFree);
  EXPECT_EQ(free.count(), 18U);
  const std::vector<CellIndex> left_room = {{-3, -2}};
  EXPECT_EQ(flood_fill(free, left_room).count(), 9U);
  draw(grid, {"..", ".."}, {0, -1});  // a door through the middle wall
  const CellBitmap opened = cells_in_state(grid.snapshot(), CellState::kFree);
  EXPECT_EQ(flood_fill(opened, left_room).count(), opened.count());
}

TEST(FloodFill, PassesOverSeedsThatAreNotFree) {
  ChunkedGrid grid(0.02);
  draw(grid, {".#."});
  const CellBitmap free = cells_in_state(grid.snapshot(), CellState::kFree);
  const std::vector<CellIndex> seeds = {{1, 0}, {1000, 1000}, {2, 0}};
  const CellBitmap reached = flood_fill(free, seeds);
  EXPECT_EQ(reached.count(), 1U);
  EXPECT_TRUE(reached.test({2, 0}));
}

TEST(FloodFill, OfAnEmptyMapIsEmpty) {
  const std::vector<CellIndex> seeds = {{0, 0}};
  EXPECT_EQ(flood_fill(cells_in_state(GridSnapshot(), CellState::kFree), seeds).count(), 0U);
}

TEST(FloodFill, AgreesWithBruteForceOnMazes) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 30; ++trial) {
    CellBitmap through;
    through.reset({{-1, -1}, {1, 1}});
    for (int y = -64; y < 128; ++y) {
      for (int x = -64; x < 128; ++x) {
        if (random() % 100 < 62) through.set({x, y});
      }
    }
    const std::vector<CellIndex> seeds = {{0, 0}, {-64, -64}, {127, 127}};
    const std::set<CellIndex> expected = brute_force(through, seeds);
    const CellBitmap reached = flood_fill(through, seeds);
    ASSERT_EQ(reached.count(), expected.size());
    for (const CellIndex c : expected) ASSERT_TRUE(reached.test(c));
  }
}

TEST(FloodFill, TakesABitmapOfSeedsAsTheirList) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 30; ++trial) {
    CellBitmap through, seeds;
    for (CellBitmap* b : {&through, &seeds}) b->reset({{-1, -1}, {1, 1}});
    std::vector<CellIndex> list;
    for (int y = -64; y < 128; ++y) {
      for (int x = -64; x < 128; ++x) {
        if (random() % 100 < 55) through.set({x, y});
        if (random() % 1000 < 4) seeds.set({x, y}), list.push_back({x, y});  // many not in `through`
      }
    }
    const std::set<CellIndex> expected = brute_force(through, list);
    const CellBitmap reached = flood_fill(through, seeds);
    ASSERT_EQ(reached.count(), expected.size());
    for (const CellIndex c : expected) ASSERT_TRUE(reached.test(c));
  }
}

}  // namespace
}  // namespace dynslam
