// SPDX-License-Identifier: MIT
#include "grid/chunked_grid.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "grid/drawn_map.h"

namespace dynslam {
namespace {

TEST(CellRules, AreUnknownUntilSeenAndTurnOverInAboutTenLooks) {
  EXPECT_EQ(cell_state(0, 0), CellState::kUnknown);
  EXPECT_EQ(cell_state(CellRule{}.gain, 0), CellState::kUnknown) << "one hit may be noise";
  EXPECT_EQ(cell_state(2 * CellRule{}.gain, 0), CellState::kOccupied);
  EXPECT_EQ(cell_state(0, CellRule{}.gain), CellState::kFree);
  ChunkedGrid grid(0.02);
  for (int i = 0; i < 20; ++i) grid.add_hit({0, 0});
  EXPECT_EQ(grid.hit({0, 0}), 255);
  int looks = 0;
  while (grid.state({0, 0}) != CellState::kFree) {
    grid.add_miss({0, 0});
    ++looks;
  }
  EXPECT_GE(looks, 5);
  EXPECT_LE(looks, 10);
}

TEST(CellRules, NeverRunOverOrUnder) {
  for (int v = 0; v < 256; ++v) {
    const auto b = static_cast<std::uint8_t>(v);
    EXPECT_EQ(raised(b, CellRule{}.gain), std::min(255, v + CellRule{}.gain));
    EXPECT_EQ(lowered(b, CellRule{}.loss), std::max(0, v - CellRule{}.loss));
  }
}

TEST(ChunkedGrid, IsUnknownWhereNothingWasSeenAndAllotsOnlyWhatWasSeen) {
  ChunkedGrid grid(0.02);
  EXPECT_EQ(grid.state({12345678, -12345678}), CellState::kUnknown);
  EXPECT_EQ(grid.chunk_count(), 0U);
  grid.add_hit({-1, -1});
  grid.add_hit({12345678, -12345678});
  EXPECT_EQ(grid.chunk_count(), 2U);
  EXPECT_EQ(grid.hit({-1, -1}), CellRule{}.gain);
  EXPECT_EQ(grid.hit({0, 0}), 0);
}

TEST(ChunkedGrid, AgreesWithAMapOfCells) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> coordinate(-150, 150), look(0, 1);
  ChunkedGrid grid(0.02);
  std::map<CellIndex, std::pair<int, int>> cells;
  for (int i = 0; i < 60000; ++i) {
    const CellIndex c{coordinate(random), coordinate(random)};
    auto& [hit, miss] = cells[c];
    if (look(random)) {
      grid.add_hit(c);
      hit = std::min(255, hit + 26), miss = std::max(0, miss - 13);
    } else {
      grid.add_miss(c);
      miss = std::min(255, miss + 26), hit = std::max(0, hit - 13);
    }
  }
  for (const auto& [c, planes] : cells) {
    ASSERT_EQ(grid.hit(c), planes.first);
    ASSERT_EQ(grid.miss(c), planes.second);
  }
}

ScanFootprint random_footprint(std::mt19937& random) {
  std::uniform_int_distribution<int> chunk(-2, 1);
  ScanFootprint f;
  const ChunkIndex low{chunk(random), chunk(random)};
  f.misses.reset({low, {low.x + 2, low.y + 1}});
  std::uniform_int_distribution<int> kind(0, 3);
  for (int r = 0; r < f.misses.rows(); ++r) {
    for (int w = 0; w < 3; ++w) {
      const int k = kind(random);
      f.misses.row(r)[w] = k == 0   ? 0
                           : k == 1 ? ~std::uint64_t{0}
                                    : (std::uint64_t{random()} << 32) | random();
    }
  }
  for (int i = 0; i < 40; ++i) {
    const CellIndex c{f.misses.first().x + static_cast<int>(random() % 192),
                      f.misses.first().y + static_cast<int>(random() % 128)};
    if (f.misses.test(c)) {
      f.misses.clear(c);
      f.hits.push_back(c);
    }
  }
  return f;
}

TEST(ChunkedGrid, AppliesAScanAsItsCellsOneByOne) {
  std::mt19937 random(11);
  ChunkedGrid fast(0.02), slow(0.02);
  for (int scan = 0; scan < 30; ++scan) {
    const ScanFootprint f = random_footprint(random);
    fast.apply(f);
    const CellIndex low = f.misses.first();
    for (int y = 0; y < f.misses.rows(); ++y) {
      for (int x = 0; x < 3 * kChunkSide; ++x) {
        if (f.misses.test({low.x + x, low.y + y})) slow.add_miss({low.x + x, low.y + y});
      }
    }
    for (const CellIndex c : f.hits) slow.add_hit(c);
    if (scan % 7 == 3) (void)fast.snapshot();
  }
  for (int y = -130; y < 200; ++y) {
    for (int x = -130; x < 260; ++x) {
      ASSERT_EQ(fast.hit({x, y}), slow.hit({x, y})) << x << " " << y;
      ASSERT_EQ(fast.miss({x, y}), slow.miss({x, y})) << x << " " << y;
    }
  }
}

TEST(ChunkedGrid, SnapshotsDoNotChange) {
  ChunkedGrid grid(0.02);
  draw(grid, {"#..", "#.#"}, {-2, -1});
  const GridSnapshot before = grid.snapshot();
  draw(grid, {"...", "..."}, {-2, -1});
  draw(grid, {"#"}, {500, 500});
  EXPECT_EQ(drawing_of(before, {-2, -1}, 3, 2), (std::vector<std::string>{"#..", "#.#"}));
  EXPECT_EQ(before.chunk_count(), 4U);
  EXPECT_EQ(before.state({500, 500}), CellState::kUnknown);
  EXPECT_EQ(drawing_of(grid.snapshot(), {-2, -1}, 3, 2), (std::vector<std::string>{"...", "..."}));
}

TEST(ChunkedGrid, RaisesTheVersionOfWhatChangesAfterASnapshotAndOfNothingElse) {
  ChunkedGrid grid(0.02);
  grid.add_hit({0, 0});
  grid.add_hit({100, 0});
  const GridSnapshot a = grid.snapshot();
  grid.add_hit({0, 0});
  grid.add_hit({1, 1});
  const GridSnapshot b = grid.snapshot();
  EXPECT_EQ(b.find({0, 0})->version, a.find({0, 0})->version + 1);
  EXPECT_EQ(b.find({1, 0}), a.find({1, 0})) << "an unchanged chunk is shared";
}

TEST(ChunkedGrid, DoesNotCopyAChunkThatIsSureAlready) {
  ChunkedGrid grid(0.02);
  ScanFootprint f;
  f.misses.reset({{0, 0}, {0, 0}});
  for (int r = 0; r < kChunkSide; ++r) f.misses.row(r)[0] = ~std::uint64_t{0};
  for (int i = 0; i < 10; ++i) grid.apply(f);
  const GridSnapshot a = grid.snapshot();
  grid.apply(f);
  EXPECT_EQ(grid.snapshot().find({0, 0}), a.find({0, 0}));
}

TEST(ChunkedGrid, StopsAtTheCapAndCountsWhatItRefuses) {
  ChunkedGrid grid(0.02, 3);
  for (int i = 0; i < 5; ++i) grid.add_hit({i * kChunkSide, 0});
  grid.add_miss({4 * kChunkSide, 5});
  ScanFootprint f;
  f.misses.reset({{10, 0}, {10, 0}});
  f.misses.set({640, 3});
  f.misses.set({641, 3});
  grid.apply(f);
  EXPECT_EQ(grid.chunk_count(), 3U);
  EXPECT_EQ(grid.cells_refused(), 2U + 1U + 2U);
  grid.add_hit({0, 0});
  EXPECT_EQ(grid.hit({0, 0}), 2 * CellRule{}.gain) << "what is there still learns";
}

/// A tile of random cells, and one of cells that are in no other.
std::pair<CellTile, CellTile> random_tiles(std::mt19937& random) {
  CellTile free, occupied;
  for (std::size_t r = 0; r < kChunkSide; ++r) {
    free[r] = std::uint64_t{random()} << 32 | random();
    occupied[r] = (std::uint64_t{random()} << 32 | random()) & ~free[r];
  }
  return {free, occupied};
}

TEST(ChunkedGrid, ShowsTheTilesOfAChunkAndForgetsWhatWasThere) {
  std::mt19937 random(12);
  ChunkedGrid grid(0.02);
  const ChunkIndex index{-2, 1};
  const CellIndex low = first_cell(index);
  for (int trial = 0; trial < 3; ++trial) {
    const auto [free, occupied] = random_tiles(random);
    grid.show(index, free, occupied);
    for (int y = 0; y < kChunkSide; ++y) {
      for (int x = 0; x < kChunkSide; ++x) {
        const CellIndex c{low.x + x, low.y + y};
        const bool is_free = free[static_cast<std::size_t>(y)] >> x & 1U;
        const bool is_occupied = occupied[static_cast<std::size_t>(y)] >> x & 1U;
        ASSERT_EQ(grid.hit(c), is_occupied ? 255 : 0);
        ASSERT_EQ(grid.miss(c), is_free ? 255 : 0);
        ASSERT_EQ(grid.state(c), is_occupied ? CellState::kOccupied
                                 : is_free   ? CellState::kFree
                                             : CellState::kUnknown);
      }
    }
  }
  EXPECT_EQ(grid.chunk_count(), 1U);
  EXPECT_EQ(grid.state({low.x - 1, low.y}), CellState::kUnknown);
}

TEST(ChunkedGrid, ShowsNothingNewToSnapshots) {
  std::mt19937 random(13);
  ChunkedGrid grid(0.02);
  const auto [free, occupied] = random_tiles(random);
  grid.show({0, 0}, free, occupied);
  const GridSnapshot before = grid.snapshot();
  grid.show({0, 0}, occupied, free);
  grid.show({1, 0}, free, occupied);
  for (int x = 0; x < kChunkSide; ++x) {
    const CellState was = free[5] >> x & 1U       ? CellState::kFree
                          : occupied[5] >> x & 1U ? CellState::kOccupied
                                                  : CellState::kUnknown;
    ASSERT_EQ(before.state({x, 5}), was);
  }
  EXPECT_EQ(before.chunk_count(), 1U);
  EXPECT_EQ(grid.snapshot().find({0, 0})->version, before.find({0, 0})->version + 1);
}

TEST(ChunkedGrid, CountsTheCellsOfTilesBeyondTheCap) {
  ChunkedGrid grid(0.02, 1);
  CellTile free{}, occupied{};
  free[3] = 0xFF;
  occupied[4] = 0x3;
  grid.show({0, 0}, free, occupied);
  EXPECT_EQ(grid.cells_refused(), 0U);
  grid.show({1, 0}, free, occupied);
  EXPECT_EQ(grid.cells_refused(), 8U + 2U);
  EXPECT_EQ(grid.chunk_count(), 1U);
  EXPECT_EQ(grid.state({64, 3}), CellState::kUnknown);
  grid.show({0, 0}, occupied, free);
  EXPECT_EQ(grid.state({1, 4}), CellState::kFree) << "what is there can still change";
}

TEST(ChunkedGrid, ReadersSeeWholeChunksWhileTheWriterWrites) {
  ChunkedGrid grid(0.02);
  ScanFootprint whole;  // gives every cell of four chunks the same value: a torn chunk would show two
  whole.misses.reset({{0, 0}, {3, 0}});
  for (int r = 0; r < kChunkSide; ++r) {
    for (int w = 0; w < 4; ++w) whole.misses.row(r)[w] = ~std::uint64_t{0};
  }
  for (int round = 0; round < 9; ++round) {
    grid.apply(whole);
    std::atomic<int> torn = 0;
    std::thread reader([seen = grid.snapshot(), &torn] {
      for (int k = 0; k < 4; ++k) {
        const Chunk* chunk = seen.find({k, 0});
        for (int y = 0; y < kChunkSide; ++y) {
          for (int x = 0; x < kChunkSide; ++x) torn += chunk->miss[y][x] != chunk->miss[0][0];
        }
      }
    });
    // Hits, then misses enough to bring every cell back to one value.
    for (int x = 0; x < 256; ++x) grid.add_hit({x, round});
    for (int look = 0; look < 10; ++look) grid.apply(whole);
    reader.join();
    EXPECT_EQ(torn, 0);
  }
}

TEST(ChunkBox, GrowsToHoldAllChunks) {
  ChunkBox box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.width(), 0);
  box.include({3, -2});
  box.include({-1, 5});
  EXPECT_EQ(box.min, (ChunkIndex{-1, -2}));
  EXPECT_EQ(box.max, (ChunkIndex{3, 5}));
}

}  // namespace
}  // namespace dynslam
