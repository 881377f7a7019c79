// SPDX-License-Identifier: MIT
#include "plan/lone_posts.h"

#include <algorithm>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

constexpr PostSize kSize{5, 15};

CellBitmap two_by_two_chunks() {
  CellBitmap cells;
  cells.reset({{-1, -1}, {0, 0}});
  return cells;
}
CellBox all_of(const CellBitmap& cells) {
  const CellIndex first = cells.first();
  return {first, {first.x + 2 * kChunkSide - 1, first.y + 2 * kChunkSide - 1}};
}

/// As it is said, cell by cell.
bool stands_alone(const CellBitmap& cells, CellIndex c, const PostSize& size) {
  for (int dy = -size.alone; dy <= size.alone; ++dy) {
    for (int dx = -size.alone; dx <= size.alone; ++dx) {
      const bool own = std::abs(dx) <= size.thick && std::abs(dy) <= size.thick;
      if (!own && cells.test({c.x + dx, c.y + dy})) return false;
    }
  }
  return true;
}

TEST(LonePosts, AreThinAndStandAlone) {
  CellBitmap cells = two_by_two_chunks();
  for (const CellIndex c : {CellIndex{-30, -30}, {-29, -30}, {-29, -29}}) cells.set(c);  // a leg
  for (int x = 10; x < 50; ++x) cells.set({x, 40});                                      // a wall
  cells.set({20, 28});                                                                   // a leg beside it
  const std::vector<CellIndex> posts = lone_posts(cells, all_of(cells), kSize);
  EXPECT_EQ(posts, (std::vector<CellIndex>{{-30, -30}, {-29, -30}, {-29, -29}}));
}

TEST(LonePosts, AreWhatLookingAtEachCellFindsToo) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> place(-kChunkSide, kChunkSide - 1), count(1, 60);
  std::size_t found = 0;
  for (int i = 0; i < 200; ++i) {
    CellBitmap cells = two_by_two_chunks();
    for (int left = count(random); left > 0; --left) cells.set({place(random), place(random)});
    const PostSize size = i % 2 == 0 ? kSize : PostSize{2, kMostAlone};
    std::vector<CellIndex> expected;
    for (int y = -kChunkSide; y < kChunkSide; ++y) {
      for (int x = -kChunkSide; x < kChunkSide; ++x)
        if (cells.test({x, y}) && stands_alone(cells, {x, y}, size)) expected.push_back({x, y});
    }
    ASSERT_EQ(lone_posts(cells, all_of(cells), size), expected) << i;
    found += expected.size();
  }
  EXPECT_GT(found, 200U);
}

TEST(LonePosts, OfAPartOnlyAreThoseInside) {
  CellBitmap cells = two_by_two_chunks();
  cells.set({-40, 0});
  cells.set({40, 0});
  EXPECT_EQ(lone_posts(cells, {{0, -10}, {50, 10}}, kSize), (std::vector<CellIndex>{{40, 0}}));
}

}  // namespace
}  // namespace dynslam
