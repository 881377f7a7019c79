// SPDX-License-Identifier: MIT
#include "autopilot/frontier_map.h"

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "autopilot/drawn_frontiers.h"

namespace dynslam {
namespace {

constexpr double kCell_m = 0.05;

ExplorationConfig with_depth(int cells, int free_cells = 1) {
  ExplorationConfig config;
  config.least_depth_m = cells * kCell_m;
  config.deep_within_m = 2 * kCell_m;
  config.least_width_m = free_cells * kCell_m;
  return config;
}

/// A grid that is drawn on with rectangles.
class Canvas {
 public:
  void fill(CellIndex low, int width, int height, CellState state) {
    std::set<ChunkIndex> changed;
    for (int y = low.y; y < low.y + height; ++y) {
      for (int x = low.x; x < low.x + width; ++x) {
        const ChunkIndex chunk = chunk_of({x, y});
        changed.insert(chunk);
        const std::uint64_t bit = std::uint64_t{1} << (x & kChunkMask);
        const auto row = static_cast<std::size_t>(y & kChunkMask);
        Tiles& tiles = tiles_[chunk];
        tiles.free[row] &= ~bit, tiles.occupied[row] &= ~bit;
        if (state == CellState::kFree) tiles.free[row] |= bit;
        if (state == CellState::kOccupied) tiles.occupied[row] |= bit;
      }
    }
    for (const ChunkIndex c : changed) grid.show(c, tiles_[c].free, tiles_[c].occupied);
  }

  ChunkedGrid grid{kCell_m};

 private:
  struct Tiles {
    CellTile free{}, occupied{};
  };
  std::map<ChunkIndex, Tiles> tiles_;
};

void fill_at_random(Canvas& canvas, std::mt19937& random) {
  const CellIndex low{static_cast<int>(random() % 200) - 130, static_cast<int>(random() % 150) - 80};
  const auto kind = random() % 5;
  const int width = 1 + static_cast<int>(random() % 60), height = 1 + static_cast<int>(random() % 60);
  canvas.fill(low, width, height,
              kind < 3    ? CellState::kFree
              : kind == 3 ? CellState::kUnknown
                          : CellState::kOccupied);
}

using CellTest = std::function<bool(CellIndex)>;

bool is_all(const CellTest& test, CellIndex low, int side) {
  for (int i = 0; i < side * side; ++i) {
    if (!test({low.x + i % side, low.y + i / side})) return false;
  }
  return true;
}

/// The cells of squares all of whose cells pass the test.
std::set<CellIndex> squares(const GridSnapshot& map, const CellTest& test, int side) {
  const CellIndex low = first_cell(map.box().min);
  const CellIndex high = first_cell({map.box().max.x + 1, map.box().max.y + 1});
  std::set<CellIndex> cells;
  for (int y = low.y - 2 * side; y <= high.y + side; ++y) {
    for (int x = low.x - 2 * side; x <= high.x + side; ++x) {
      if (!is_all(test, {x, y}, side)) continue;
      for (int i = 0; i < side * side; ++i) cells.insert({x + i % side, y + i / side});
    }
  }
  return cells;
}

/// The cells of `within` beside a cell of the set too.
std::set<CellIndex> grown(const std::set<CellIndex>& cells, const std::set<CellIndex>& within) {
  std::set<CellIndex> all = cells;
  for (const CellIndex c : within) {
    if (cells.contains({c.x - 1, c.y}) || cells.contains({c.x + 1, c.y}) || cells.contains({c.x, c.y - 1}) ||
        cells.contains({c.x, c.y + 1}))
      all.insert(c);
  }
  return all;
}

/// Cell by cell, row by row, as the definition says.
std::vector<CellIndex> frontier_cells_one_by_one(const GridSnapshot& map, int depth, int width) {
  const auto is_unknown = [&](CellIndex c) { return map.state(c) == CellState::kUnknown; };
  const auto is_free = [&](CellIndex c) { return map.state(c) == CellState::kFree; };
  const std::set<CellIndex> ragged = squares(map, is_unknown, width);
  const std::set<CellIndex> unknown = grown(grown(squares(map, is_unknown, depth), ragged), ragged);
  const int gap = (width - 1) / 2;
  const std::set<CellIndex> no_gap = squares(map, is_unknown, gap + 1);
  const std::set<CellIndex> with_gaps = squares(
      map, [&](CellIndex c) { return is_free(c) || (is_unknown(c) && !no_gap.contains(c)); }, width);
  std::set<CellIndex> wide = squares(map, is_free, width);
  for (int step = 0; gap > 0 && step < 2 * gap + 1; ++step) wide = grown(wide, with_gaps);
  std::vector<CellIndex> cells;
  for (const CellIndex c : wide) {
    if (!is_free(c)) continue;
    if (unknown.contains({c.x - 1, c.y}) || unknown.contains({c.x + 1, c.y}) ||
        unknown.contains({c.x, c.y - 1}) || unknown.contains({c.x, c.y + 1}))
      cells.push_back(c);
  }
  std::sort(cells.begin(), cells.end(),
            [](CellIndex a, CellIndex b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return cells;
}

/// Until what was known before is unknown like all else. Returns how many chunks were done anew.
std::size_t update_for_good(FrontierMap& frontiers, const GridSnapshot& map) {
  static Time now{};
  std::size_t done = 0;
  for (int i = 0; i < 3; ++i) done += frontiers.update(now += FrontierMap::kForgotten, map);
  return done;
}

TEST(FrontierMap, WhatIsForgottenIsNoFrontierForAWhile) {
  Canvas canvas;
  canvas.fill({0, 0}, 60, 60, CellState::kFree);
  canvas.fill({20, 20}, 10, 10, CellState::kOccupied);
  FrontierMap frontiers(with_depth(3));
  Time now{};
  frontiers.update(now, canvas.grid.snapshot());
  canvas.fill({20, 20}, 10, 10, CellState::kUnknown);
  EXPECT_EQ(frontiers.update(now, canvas.grid.snapshot()), 0U);
  EXPECT_FALSE(frontiers.is_frontier({19, 25}));
  EXPECT_TRUE(frontiers.is_frontier({0, 25})) << "what was never known is";
  for (int s = 0; s < 120; ++s) frontiers.update(now += std::chrono::seconds(1), canvas.grid.snapshot());
  EXPECT_TRUE(frontiers.is_frontier({19, 25})) << "nobody looked there for a long time";
  canvas.fill({20, 20}, 10, 10, CellState::kFree);
  frontiers.update(now, canvas.grid.snapshot());
  EXPECT_FALSE(frontiers.is_frontier({19, 25}));
}

TEST(FrontierMap, TheEdgeOfTheUnknownMayBeRagged) {
  Canvas canvas;
  canvas.fill({0, 0}, 40, 40, CellState::kFree);
  canvas.fill({10, 40}, 20, 2, CellState::kFree);
  canvas.fill({16, 40}, 8, 2, CellState::kUnknown);  // two cells deep: too shallow on its own
  FrontierMap frontiers(with_depth(5, 2));
  update_for_good(frontiers, canvas.grid.snapshot());
  EXPECT_TRUE(frontiers.is_frontier({12, 41}));
  EXPECT_TRUE(frontiers.is_frontier({20, 39})) << "it lies before what is deep";
  EXPECT_FALSE(frontiers.is_frontier({20, 38}));
  canvas.fill({0, 42}, 40, 1, CellState::kOccupied);
  update_for_good(frontiers, canvas.grid.snapshot());
  EXPECT_FALSE(frontiers.is_frontier({20, 39})) << "it lies before a wall";
}

TEST(FrontierMap, GapsBetweenRaysDoNotHideWhatLiesBeyond) {
  Canvas canvas;
  canvas.fill({0, 0}, 40, 40, CellState::kFree);
  canvas.fill({0, 41}, 40, 1, CellState::kFree);  // the last ray, beside a row that none went along
  FrontierMap frontiers(with_depth(5, 3));
  update_for_good(frontiers, canvas.grid.snapshot());
  EXPECT_TRUE(frontiers.is_frontier({20, 41}));
  canvas.fill({0, 38}, 40, 2, CellState::kOccupied);
  update_for_good(frontiers, canvas.grid.snapshot());
  EXPECT_FALSE(frontiers.is_frontier({20, 41})) << "a lone ray beyond a wall";
  canvas.fill({0, 43}, 40, 1, CellState::kFree);
  canvas.fill({0, 45}, 40, 1, CellState::kFree);
  update_for_good(frontiers, canvas.grid.snapshot());
  EXPECT_FALSE(frontiers.is_frontier({20, 45})) << "rays beyond a wall, with gaps between";
}

TEST(FrontierMap, TellsHowMuchLiesBeyond) {
  for (const int x0 : {-70, -20, 40}) {
    Canvas canvas;
    canvas.fill({x0, 0}, 50, 20, CellState::kFree);
    // Left a nook of 10 x 6 cells behind a gap in the wall, right the open.
    canvas.fill({x0, 20}, 26, 8, CellState::kOccupied);
    canvas.fill({x0 + 10, 20}, 10, 1, CellState::kFree);
    canvas.fill({x0 + 10, 21}, 10, 6, CellState::kUnknown);
    FrontierMap map(with_depth(4));
    map.update({}, canvas.grid.snapshot());
    Frontier nook, open;
    nook.middle_map = cell_centre({x0 + 15, 20}, kCell_m);
    open.middle_map = cell_centre({x0 + 38, 19}, kCell_m);
    EXPECT_NEAR(map.beyond_m2(nook), 60 * kCell_m * kCell_m, 1e-9) << x0;
    EXPECT_GT(map.beyond_m2(open), 4.0) << x0;
    canvas.fill({x0 + 10, 24}, 10, 1, CellState::kOccupied);
    map.update({}, canvas.grid.snapshot());
    EXPECT_EQ(map.beyond_m2(nook), 0.0) << "too shallow to count";
  }
}

TEST(FrontierMap, TellsWhatIsWorthButALastLook) {
  Canvas canvas;
  canvas.fill({0, 0}, 60, 20, CellState::kFree);
  canvas.fill({0, 20}, 60, 1, CellState::kOccupied);
  canvas.fill({10, 20}, 7, 1, CellState::kFree);
  canvas.fill({30, 20}, 12, 1, CellState::kFree);
  canvas.fill({-1, -1}, 62, 1, CellState::kOccupied);
  canvas.fill({-1, -1}, 1, 22, CellState::kOccupied);
  canvas.fill({60, -1}, 1, 22, CellState::kOccupied);
  ExplorationConfig config = with_depth(4);
  config.least_length_m = 0.5;
  config.last_look_length_m = 0.3;
  FrontierMap map(config);
  map.update({}, canvas.grid.snapshot());
  const std::vector<Frontier> found = map.frontiers(true);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(found[0].is_short) << "0.35 m";
  EXPECT_FALSE(found[1].is_short) << "0.6 m";
  for (const Frontier& f : map.frontiers()) EXPECT_FALSE(f.is_short) << "a rest at most";
}

TEST(FrontierMap, KeepsUpWithAChangingMap) {
  std::mt19937 random(3);
  for (const auto& [depth, width] : {std::pair{1, 1}, {5, 1}, {1, 3}, {4, 3}, {8, 5}}) {
    Canvas canvas;
    FrontierMap frontiers(with_depth(depth, width));
    std::size_t seen = 0;
    for (int round = 0; round < 6; ++round) {
      for (auto n = 1 + random() % 3; n > 0; --n) fill_at_random(canvas, random);
      const GridSnapshot map = canvas.grid.snapshot();
      update_for_good(frontiers, map);
      const std::vector<CellIndex> expected = frontier_cells_one_by_one(map, depth, width);
      ASSERT_EQ(frontiers.cells(), expected) << depth << ", " << width << ", " << round;
      for (const CellIndex c : expected) ASSERT_TRUE(frontiers.is_frontier(c));
      FrontierMap afresh(with_depth(depth, width));
      afresh.update({}, map);
      ASSERT_EQ(afresh.cells(), expected);
      seen += expected.size();
    }
    EXPECT_GT(seen, 100U);
  }
}

TEST(FrontierMap, DoesNothingAnewWhenNoCellChangesItsState) {
  Canvas canvas;
  canvas.fill({-100, -100}, 300, 300, CellState::kFree);
  FrontierMap frontiers;
  EXPECT_GT(frontiers.update({}, canvas.grid.snapshot()), 20U);
  EXPECT_EQ(frontiers.update({}, canvas.grid.snapshot()), 0U);
  canvas.grid.add_hit({0, 0});  // less sure, free still
  EXPECT_EQ(frontiers.update({}, canvas.grid.snapshot()), 0U);
}

TEST(FrontierMap, DoesAnewOnlyWhatIsNearAChange) {
  Canvas canvas;
  canvas.fill({0, 0}, 640, 640, CellState::kFree);
  FrontierMap frontiers(with_depth(5));
  update_for_good(frontiers, canvas.grid.snapshot());
  canvas.fill({160, 160}, 2, 2, CellState::kUnknown);
  EXPECT_EQ(update_for_good(frontiers, canvas.grid.snapshot()), 1U) << "in the middle of a chunk";
  canvas.fill({200, 160}, 2, 2, CellState::kOccupied);
  EXPECT_EQ(update_for_good(frontiers, canvas.grid.snapshot()), 1U);
  canvas.fill({192, 192}, 2, 2, CellState::kUnknown);
  EXPECT_EQ(update_for_good(frontiers, canvas.grid.snapshot()), 4U) << "in a corner";
}

TEST(FrontierMap, FollowsAMapThatWasDrawnAnew) {
  Canvas wide, narrow;
  wide.fill({-100, -100}, 300, 300, CellState::kFree);
  narrow.fill({10, 10}, 30, 30, CellState::kFree);
  FrontierMap frontiers(with_depth(3));
  for (const Canvas* canvas : {&wide, &narrow, &wide}) {
    const GridSnapshot map = const_cast<Canvas*>(canvas)->grid.snapshot();
    update_for_good(frontiers, map);
    EXPECT_EQ(frontiers.cells(), frontier_cells_one_by_one(map, 3, 1));
  }
}

TEST(FrontierMap, BeginsAnewWithCellsOfAnotherSize) {
  FrontierMap frontiers;
  Canvas canvas;
  canvas.fill({0, 0}, 50, 50, CellState::kFree);
  frontiers.update({}, canvas.grid.snapshot());
  EXPECT_FALSE(frontiers.cells().empty());
  ChunkedGrid other(0.02);
  frontiers.update({}, other.snapshot());
  EXPECT_TRUE(frontiers.cells().empty());
  EXPECT_TRUE(frontiers.frontiers().empty());
}

TEST(FrontierMap, OfNothingIsEmpty) {
  FrontierMap frontiers;
  EXPECT_EQ(frontiers.update({}, GridSnapshot()), 0U);
  EXPECT_TRUE(frontiers.cells().empty());
  EXPECT_FALSE(frontiers.is_frontier({0, 0}));
}

}  // namespace
}  // namespace dynslam
