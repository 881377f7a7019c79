// SPDX-License-Identifier: MIT
#include "autopilot/deep_cells.h"

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

constexpr int kSide = 3 * kChunkSide;

/// By column and row; what is outside of the window is not in it.
bool test(const ChunkWindow& cells, int x, int y) {
  if (x < 0 || y < 0 || x >= kSide || y >= kSide) return false;
  return (cells[static_cast<std::size_t>(y)][static_cast<std::size_t>(x / kChunkSide)] >> (x % kChunkSide) &
          1U) != 0;
}

/// Everything but random rectangles.
ChunkWindow random_window(std::mt19937& random, int holes) {
  ChunkWindow cells;
  for (WideRow& row : cells) row.fill(~std::uint64_t{0});
  for (int i = 0; i < holes; ++i) {
    const int x0 = static_cast<int>(random() % kSide), y0 = static_cast<int>(random() % kSide);
    const int w = 1 + static_cast<int>(random() % 9), h = 1 + static_cast<int>(random() % 9);
    for (int y = y0; y < std::min(kSide, y0 + h); ++y) {
      for (int x = x0; x < std::min(kSide, x0 + w); ++x)
        cells[static_cast<std::size_t>(y)][static_cast<std::size_t>(x / kChunkSide)] &=
            ~(std::uint64_t{1} << (x % kChunkSide));
    }
  }
  return cells;
}

std::vector<bool> deep_one_by_one(const ChunkWindow& cells, int side) {
  std::vector<bool> deep(static_cast<std::size_t>(kSide * kSide));
  for (int y0 = 0; y0 + side <= kSide; ++y0) {
    for (int x0 = 0; x0 + side <= kSide; ++x0) {
      bool is_full = true;
      for (int i = 0; is_full && i < side * side; ++i) is_full = test(cells, x0 + i % side, y0 + i / side);
      for (int i = 0; is_full && i < side * side; ++i)
        deep[static_cast<std::size_t>((y0 + i / side) * kSide + x0 + i % side)] = true;
    }
  }
  return deep;
}

TEST(DeepCells, AreThoseOfSquaresThatFit) {
  std::mt19937 random(1);
  for (const int side : {1, 2, 3, 5, 8, 13, 31, kMostDepth}) {
    const ChunkWindow cells = random_window(random, 50000 / (side * side + 60));
    const std::vector<bool> expected = deep_one_by_one(cells, side);
    ChunkWindow deep = cells;
    keep_deep(deep, side);
    int kept = 0, lost = 0;
    for (int y = kChunkSide - kBeside; y < 2 * kChunkSide + kBeside; ++y) {
      for (int x = kChunkSide - kBeside; x < 2 * kChunkSide + kBeside; ++x) {
        ASSERT_EQ(test(deep, x, y), expected[static_cast<std::size_t>(y * kSide + x)])
            << side << ": " << x << " " << y;
        kept += test(deep, x, y) ? 1 : 0;
        lost += test(cells, x, y) && !test(deep, x, y) ? 1 : 0;
      }
    }
    EXPECT_GT(kept, 0) << side;
    EXPECT_EQ(lost > 0, side > 1) << side;
  }
}

TEST(DeepCells, GrowWithinWhatIsThere) {
  std::mt19937 random(3);
  const ChunkWindow within = random_window(random, 2000);
  ChunkWindow cells = within;
  keep_deep(cells, 4);
  for (const int steps : {0, 1, 2, 3}) {
    ChunkWindow grown = cells;
    grow(grown, within, steps);
    ChunkWindow expected = cells;
    for (int step = 0; step < steps; ++step) {
      const ChunkWindow before = expected;
      for (int y = 1; y + 1 < kSide; ++y) {
        for (int x = 1; x + 1 < kSide; ++x) {
          const bool is_beside = test(before, x - 1, y) || test(before, x + 1, y) || test(before, x, y - 1) ||
                                 test(before, x, y + 1);
          if (is_beside && test(within, x, y))
            expected[static_cast<std::size_t>(y)][static_cast<std::size_t>(x / kChunkSide)] |=
                std::uint64_t{1} << (x % kChunkSide);
        }
      }
    }
    for (int y = kChunkSide - 1; y <= 2 * kChunkSide; ++y) {
      for (int x = kChunkSide - 1; x <= 2 * kChunkSide; ++x)
        ASSERT_EQ(test(grown, x, y), test(expected, x, y)) << steps << ": " << x << " " << y;
    }
    EXPECT_EQ(middle_of(grown) == middle_of(cells), steps == 0);
  }
}

TEST(DeepCells, AreBesideTheFourAroundThem) {
  std::mt19937 random(2);
  const ChunkWindow cells = random_window(random, 3000);
  const CellTile found = beside(cells);
  for (int y = 0; y < kChunkSide; ++y) {
    for (int x = 0; x < kChunkSide; ++x) {
      const int wide_x = x + kChunkSide, wide_y = y + kChunkSide;
      const bool expected = test(cells, wide_x - 1, wide_y) || test(cells, wide_x + 1, wide_y) ||
                            test(cells, wide_x, wide_y - 1) || test(cells, wide_x, wide_y + 1);
      ASSERT_EQ((found[static_cast<std::size_t>(y)] >> x & 1U) != 0, expected) << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace dynslam
