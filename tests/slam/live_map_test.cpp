// SPDX-License-Identifier: MIT
#include "slam/live_map.h"

#include <gtest/gtest.h>

namespace dynslam {
namespace {

/// A chunk with free space below row 20 and a wall in it.
DrawnChunk wall_in(ChunkIndex index) {
  DrawnChunk chunk{index};
  for (std::size_t y = 0; y < 20; ++y) chunk.free[y] = ~std::uint64_t{0};
  chunk.occupied[20] = ~std::uint64_t{0};
  return chunk;
}

/// A scan that hits cells and passes others.
ScanFootprint scan(const std::vector<CellIndex>& hits, const std::vector<CellIndex>& misses = {}) {
  ScanFootprint footprint;
  footprint.misses.reset({{-1, -1}, {1, 1}});
  for (const CellIndex c : misses) footprint.misses.set(c);
  footprint.hits = hits;
  return footprint;
}

/// All cells from one corner to the other.
std::vector<CellIndex> block(CellIndex low, CellIndex high) {
  std::vector<CellIndex> cells;
  for (std::int32_t y = low.y; y <= high.y; ++y) {
    for (std::int32_t x = low.x; x <= high.x; ++x) cells.push_back({x, y});
  }
  return cells;
}

TEST(LiveMap, ShowsWhatWasDrawnAFewChunksATurn) {
  LiveMap map(0.02, 100);
  map.redrawn(std::vector{wall_in({0, 0}), wall_in({1, 0})});
  EXPECT_EQ(map.waiting(), 2U);
  map.show(1);
  EXPECT_EQ(map.grid().state({5, 20}), CellState::kOccupied);
  EXPECT_EQ(map.grid().state({70, 20}), CellState::kUnknown);
  map.show(5);
  EXPECT_EQ(map.grid().state({70, 5}), CellState::kFree);
  EXPECT_EQ(map.waiting(), 0U);
}

TEST(LiveMap, AHitBesideADrawnWallIsAHitOfTheWall) {
  LiveMap map(0.02, 100);
  map.redrawn(std::vector{wall_in({0, 0})});
  map.show(1);
  for (int i = 0; i < 20; ++i) map.draw(scan({{5, 21}, {6, 18}, {7, 22}}));
  EXPECT_EQ(map.grid().state({5, 20}), CellState::kOccupied);
  EXPECT_NE(map.grid().state({5, 21}), CellState::kOccupied);
  EXPECT_NE(map.grid().state({6, 18}), CellState::kOccupied);
  EXPECT_NE(map.grid().state({7, 22}), CellState::kOccupied);
}

TEST(LiveMap, WhatAppearsIsThereAtOnceAndGoesWhenItIsNotSeenAgain) {
  LiveMap map(0.02, 100);
  map.redrawn(std::vector{wall_in({0, 0})});
  map.show(1);
  for (int i = 0; i < 12; ++i) map.draw(scan({{30, 8}}, {{-20, -20}}));
  EXPECT_EQ(map.grid().state({30, 8}), CellState::kOccupied) << "within a second of scans";
  EXPECT_EQ(map.grid().state({-20, -20}), CellState::kFree) << "where nothing was drawn yet";
  map.redrawn({});
  map.show(100);
  EXPECT_EQ(map.grid().state({30, 8}), CellState::kOccupied) << "the back end may not know yet";
  std::vector<CellIndex> around = block({29, 7}, {31, 9});
  around.push_back({-20, -20});
  map.draw(scan({}, around));
  map.redrawn({});
  map.show(100);
  EXPECT_EQ(map.grid().state({30, 8}), CellState::kFree) << "now the back end knows better";
  EXPECT_EQ(map.grid().state({-20, -20}), CellState::kUnknown);
}

TEST(LiveMap, NothingOfScansIsLeftInTheEnd) {
  LiveMap map(0.02, 100);
  map.redrawn(std::vector{wall_in({0, 0})});
  map.show(1);
  for (int i = 0; i < 12; ++i) map.draw(scan({{30, 8}}, {{-20, -20}, {5, 20}}));
  map.settle(std::vector{wall_in({1, 0})});
  EXPECT_EQ(map.grid().state({30, 8}), CellState::kFree);
  EXPECT_EQ(map.grid().state({5, 20}), CellState::kOccupied);
  EXPECT_EQ(map.grid().state({-20, -20}), CellState::kUnknown);
  EXPECT_EQ(map.grid().state({70, 20}), CellState::kOccupied) << "the last word counts";
  EXPECT_EQ(map.waiting(), 0U);
}

TEST(LiveMap, AWallThatIsGoneIsGoneAfterAFewScans) {
  LiveMap map(0.02, 100);
  map.redrawn(std::vector{wall_in({0, 0})});
  map.show(1);
  int scans = 0;
  for (; map.grid().state({5, 20}) == CellState::kOccupied && scans < 100; ++scans)
    map.draw(scan({}, block({2, 19}, {8, 21})));
  EXPECT_LE(scans, 10);
  EXPECT_EQ(map.grid().state({2, 20}), CellState::kOccupied) << "one was not seen beyond";
}

TEST(LiveMap, AWallThatIsSeenAslantIsNotEaten) {
  LiveMap map(0.02, 100);
  map.redrawn(std::vector{wall_in({0, 0})});
  map.show(1);
  for (int i = 0; i < 100; ++i) map.draw(scan({{30, 22}}, block({2, 15}, {28, 20})));
  for (int x = 2; x <= 28; ++x) EXPECT_EQ(map.grid().state({x, 20}), CellState::kOccupied) << x;
  map.redrawn({});
  map.show(100);
  EXPECT_EQ(map.grid().state({10, 20}), CellState::kOccupied) << "nor when it is drawn anew";
}

}  // namespace
}  // namespace dynslam
