// SPDX-License-Identifier: MIT
#include "server/map_delivery.h"

#include <set>

#include <gtest/gtest.h>

#include "pipe/clock.h"
#include "server/feeds.h"
#include "server/wire_bytes.h"

namespace dynslam {
namespace {

CellIndex in_chunk(std::int32_t x, std::int32_t y) { return {64 * x + 3, 64 * y + 5}; }

/// Makes a cell of a chunk look different.
void change(ChunkedGrid& grid, std::int32_t x, std::int32_t y, int looks = 3) {
  for (int i = 0; i < looks; ++i) grid.add_hit(in_chunk(x, y));
}

/// Draws a piece of wall into a chunk, in one of its columns.
void build(ChunkedGrid& grid, std::int32_t x, std::int32_t y, int column) {
  for (int i = 0; i < 3 * MapVersions::kManyCells; ++i) grid.add_hit({64 * x + column, 64 * y + 10 + i / 3});
}

class MapDeliveryTest : public testing::Test {
 protected:
  MapDeliveryTest() {
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y) change(grid, x, y);
    versions.update(grid.snapshot(), time_at_s(1));
  }
  std::vector<ChunkIndex> next(MapDelivery& delivery, ChunkIndex robot, std::size_t most) {
    std::vector<ChunkIndex> picked;
    for (const auto& pick : delivery.next(versions, robot, most)) picked.push_back(pick.index);
    return picked;
  }

  ChunkedGrid grid{0.02};
  MapVersions versions;
};

TEST_F(MapDeliveryTest, TheNearestComeFirstAndEachOnce) {
  MapDelivery delivery;
  EXPECT_EQ(next(delivery, {2, 2}, 1), (std::vector<ChunkIndex>{{2, 2}}));
  std::set<ChunkIndex> all = {{2, 2}};
  while (!delivery.round_done())
    for (const ChunkIndex c : next(delivery, {2, 2}, 4)) EXPECT_TRUE(all.insert(c).second);
  EXPECT_EQ(all.size(), 25U);
  EXPECT_TRUE(next(delivery, {2, 2}, 4).empty());
}

TEST_F(MapDeliveryTest, WhatIsFarGetsItsTurnThoughTheNearChangesAlways) {
  MapDelivery delivery;
  std::set<ChunkIndex> all;
  for (int turn = 0; turn < 13; ++turn) {
    for (const ChunkIndex c : next(delivery, {0, 0}, 2)) all.insert(c);
    build(grid, 0, 0, 10 + turn);
    versions.update(grid.snapshot(), time_at_s(1.1 + 0.1 * turn));
  }
  EXPECT_EQ(all.size(), 25U);
}

TEST_F(MapDeliveryTest, AClientGoesOnFromWhatItHas) {
  ChunkVersions has;
  for (const auto& [index, entry] : versions.chunks()) has[index] = entry.version;
  has.erase({1, 1});
  has[{-1, 0}] = 77;  // of another time
  MapDelivery delivery(has);
  EXPECT_EQ(next(delivery, {1, 1}, 10), (std::vector<ChunkIndex>{{1, 1}, {-1, 0}}));
}

TEST_F(MapDeliveryTest, OnlyWhatCanBeSeenCountsAsAChange) {
  change(grid, 1, 0, 2);
  versions.update(grid.snapshot(), time_at_s(9));
  const auto before = versions.chunks().at({1, 0});
  EXPECT_EQ(before.version, 2U) << "it is sure now";
  change(grid, 1, 0, 5);  // a little surer
  versions.update(grid.snapshot(), time_at_s(20));
  EXPECT_EQ(versions.chunks().at({1, 0}).version, before.version);
  EXPECT_EQ(versions.chunks().at({1, 0}).changed, time_at_s(9));
  EXPECT_GT(versions.chunks().at({1, 0}).grid_version, before.grid_version);
}

TEST_F(MapDeliveryTest, ManyCellsCountAtOnceAndFewAfterAWhile) {
  const auto version_at = [&](double t_s) {
    versions.update(grid.snapshot(), time_at_s(t_s));
    return versions.chunks().at({0, 0}).version;
  };
  build(grid, 0, 0, 20);
  EXPECT_EQ(version_at(1.1), 2U);
  for (int i = 0; i < 3; ++i) grid.add_hit({40, 40});
  EXPECT_EQ(version_at(1.2), 2U);
  EXPECT_EQ(version_at(3.0), 2U);
  EXPECT_EQ(version_at(3.2), 3U) << "though the grid is as it was";
  EXPECT_EQ(version_at(9.0), 3U);
}

TEST_F(MapDeliveryTest, ACellThatGoesToAndFroIsNoChange) {
  const auto version_at = [&](double t_s) {
    versions.update(grid.snapshot(), time_at_s(t_s));
    return versions.chunks().at({0, 0}).version;
  };
  for (int i = 0; i < 2; ++i) grid.add_miss({40, 40});
  EXPECT_EQ(version_at(5.0), 2U) << "free";
  for (int i = 0; i < 2; ++i) grid.add_hit({40, 40});
  EXPECT_EQ(version_at(5.1), 2U) << "occupied for a moment";
  grid.add_miss({40, 40});
  EXPECT_EQ(version_at(9.0), 2U) << "free";
}

TEST(MapFeed, TellsEachClientWhatItLacksAndThenThatItHasAll) {
  Ports ports;
  SteppedClock clock(time_at_s(5));
  MapFeed feed(ports, clock, 42);
  MapDelivery delivery;
  EXPECT_FALSE(feed.next(delivery, 2, false)) << "there is no map yet";
  ChunkedGrid grid(0.05);
  for (int x = 0; x < 3; ++x) change(grid, x, 0);
  WorldState world;
  world.map = grid.snapshot();
  ports.world.put(world);

  const auto first = feed.next(delivery, 2, false);
  ASSERT_TRUE(first);
  EXPECT_EQ(read_le<std::uint8_t>(*first, 1), 0);
  EXPECT_EQ(read_le<std::uint16_t>(*first, 2), 2);
  EXPECT_EQ(read_le<float>(*first, 4), 0.05F);
  EXPECT_EQ(read_le<std::uint64_t>(*first, 8), 42U);
  EXPECT_EQ(read_le<double>(*first, 16), 5.0);
  const auto second = feed.next(delivery, 2, false);
  ASSERT_TRUE(second);
  EXPECT_EQ(read_le<std::uint8_t>(*second, 1), 1);
  EXPECT_EQ(read_le<std::uint16_t>(*second, 2), 1);
  EXPECT_FALSE(feed.next(delivery, 2, true));
  MapDelivery other;
  EXPECT_EQ(read_le<std::uint16_t>(feed.next(other, 10, false).value(), 2), 3);
}

}  // namespace
}  // namespace dynslam
