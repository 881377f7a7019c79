// SPDX-License-Identifier: MIT
#include "grid/tiled_bitmap.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

constexpr ChunkBox kBox{{-2, -1}, {1, 2}};

/// Chunks with nothing, everything, or some of their cells set.
CellBitmap random_cells(std::mt19937& random) {
  CellBitmap cells;
  cells.reset(kBox);
  for (int row = 0; row < kBox.height(); ++row) {
    for (int w = 0; w < kBox.width(); ++w) {
      const auto kind = random() % 4;
      for (int r = 0; r < kChunkSide; ++r) {
        const std::uint64_t some = std::uint64_t{random()} << 32 | random();
        cells.row(row * kChunkSide + r)[w] = kind == 0 ? 0 : kind == 1 ? ~std::uint64_t{0} : some;
      }
    }
  }
  return cells;
}

/// Visits the cells of the box and a chunk all round.
template <class Visit>
void for_each_cell_around(Visit&& visit) {
  for (int y = (kBox.min.y - 1) * kChunkSide; y < (kBox.max.y + 2) * kChunkSide; ++y) {
    for (int x = (kBox.min.x - 1) * kChunkSide; x < (kBox.max.x + 2) * kChunkSide; ++x)
      visit(CellIndex{x, y});
  }
}

TEST(TiledBitmap, HoldsTheCellsItWasMadeOf) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 10; ++trial) {
    const CellBitmap cells = random_cells(random);
    const TiledBitmap tiled(cells);
    EXPECT_EQ(tiled.count(), cells.count());
    EXPECT_EQ(tiled.empty(), cells.count() == 0);
    for_each_cell_around([&](CellIndex c) { ASSERT_EQ(tiled.test(c), cells.test(c)) << c.x << " " << c.y; });
  }
}

TEST(TiledBitmap, GivesWordsThatBeginAnywhere) {
  std::mt19937 random(4);
  const CellBitmap cells = random_cells(random);
  const TiledBitmap tiled(cells);
  for (int i = 0; i < 3000; ++i) {
    const CellIndex first{static_cast<int>(random() % 500) - 250, static_cast<int>(random() % 400) - 150};
    const std::uint64_t word = tiled.word(first);
    for (int b = 0; b < 64; ++b)
      ASSERT_EQ((word >> b & 1U) != 0, cells.test({first.x + b, first.y})) << first.x << "+" << b;
  }
  EXPECT_EQ(tiled.word({1 << 30, -(1 << 30)}), 0U);
}

TEST(TiledBitmap, GivesWordsOfManyRowsAtOnce) {
  std::mt19937 random(7);
  const TiledBitmap tiled(random_cells(random));
  for (int i = 0; i < 300; ++i) {
    const CellIndex first{static_cast<int>(random() % 500) - 250, static_cast<int>(random() % 400) - 150};
    std::vector<std::uint64_t> rows(random() % 150, 42);
    tiled.words(first, rows);
    for (std::size_t r = 0; r < rows.size(); ++r)
      ASSERT_EQ(rows[r], tiled.word({first.x, first.y + static_cast<int>(r)})) << r;
  }
}

TEST(TiledBitmap, GivesTilesOfWordsAndClearOnesOutside) {
  std::mt19937 random(5);
  const TiledBitmap tiled(random_cells(random));
  for (int y = kBox.min.y - 1; y <= kBox.max.y + 1; ++y) {
    for (int x = kBox.min.x - 1; x <= kBox.max.x + 1; ++x) {
      for (int r = 0; r < kChunkSide; ++r)
        ASSERT_EQ(tiled.tile({x, y})[static_cast<std::size_t>(r)],
                  tiled.word({x * kChunkSide, y * kChunkSide + r}));
    }
  }
  EXPECT_EQ(tiled.tile({kBox.max.x + 1, 0}), CellTile{});
}

TEST(TiledBitmap, BoundsAreTheLeastRectangleOfItsCells) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 100; ++trial) {
    CellBitmap cells;
    cells.reset(kBox);
    CellBox least{{1000, 1000}, {-1000, -1000}};
    for (auto n = 1 + random() % 5; n > 0; --n) {
      const CellIndex c{static_cast<int>(random() % 256) - 128, static_cast<int>(random() % 256) - 64};
      cells.set(c);
      least.min = {std::min(least.min.x, c.x), std::min(least.min.y, c.y)};
      least.max = {std::max(least.max.x, c.x), std::max(least.max.y, c.y)};
    }
    const TiledBitmap tiled(cells);
    ASSERT_EQ(tiled.bounds().min, least.min);
    ASSERT_EQ(tiled.bounds().max, least.max);
    ASSERT_EQ(tiled.box().min, chunk_of(least.min)) << "no chunk more than needed";
    ASSERT_EQ(tiled.box().max, chunk_of(least.max));
  }
}

TEST(TiledBitmap, TakesNextToNothingForWhatIsFullOrClear) {
  CellBitmap cells;
  cells.reset({{-8, -8}, {7, 7}});
  for (int r = 0; r < cells.rows(); ++r) {
    for (int w = 0; w < cells.words_per_row(); ++w) cells.row(r)[w] = ~std::uint64_t{0};
  }
  const TiledBitmap full(cells);
  EXPECT_EQ(full.count(), std::size_t{256 * 64 * 64});
  EXPECT_LE(full.bytes(), std::size_t{256 * 4}) << "128 KiB as plain bits";
  cells.clear({-1, -1});
  EXPECT_EQ(TiledBitmap(cells).bytes(), full.bytes() + sizeof(CellTile)) << "one chunk is no longer full";
  cells.reset({{-8, -8}, {7, 7}});
  cells.set({-512, -512});
  cells.set({511, 511});
  EXPECT_EQ(TiledBitmap(cells).bytes(), full.bytes() + 2 * sizeof(CellTile));
}

TEST(TiledBitmap, OfNothingIsEmpty) {
  CellBitmap clear;
  clear.reset(kBox);
  for (const TiledBitmap& nothing : {TiledBitmap(), TiledBitmap(CellBitmap()), TiledBitmap(clear)}) {
    EXPECT_TRUE(nothing.empty());
    EXPECT_TRUE(nothing.bounds().empty());
    EXPECT_EQ(nothing.count(), 0U);
    EXPECT_EQ(nothing.bytes(), 0U);
    EXPECT_EQ(nothing.word({-3, 0}), 0U);
    EXPECT_FALSE(nothing.test({0, 0}));
  }
}

}  // namespace
}  // namespace dynslam
