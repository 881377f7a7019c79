// SPDX-License-Identifier: MIT
#include "slam/global_map.h"

#include <algorithm>
#include <limits>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grid/drawn_map.h"

namespace dynslam {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
constexpr double kCell_m = 0.02;

using Rows = std::vector<std::string>;

/// Free space with a wall around it.
Rows room(std::size_t width = 40, std::size_t height = 30) {
  Rows rows(height, std::string(width, '.'));
  rows.front() = rows.back() = std::string(width, '#');
  for (std::string& row : rows) row.front() = row.back() = '#';
  return rows;
}

/// Puts a box into a room: its sides are seen, its inside is not. Its lower left cell is (x, y).
Rows with_box(Rows rows, std::size_t x, std::size_t y, std::size_t side) {
  for (std::size_t i = 0; i < side; ++i) {
    for (std::size_t k = 0; k < side; ++k) {
      const bool is_side = i == 0 || i + 1 == side || k == 0 || k + 1 == side;
      rows[rows.size() - 1 - y - i][x + k] = is_side ? '#' : ' ';
    }
  }
  return rows;
}

Rows part_of(const Rows& rows, std::size_t first_column, std::size_t columns) {
  Rows part;
  for (const std::string& row : rows) part.push_back(row.substr(first_column, columns));
  return part;
}

/// A finished map as it is seen: '#' surface, '.' free; the lower left cell is `low`, its origin is the drawn
/// frame's.
std::shared_ptr<const FinishedMap> drawn(std::uint32_t id, const Rows& rows, CellIndex low = {}) {
  auto map = std::make_shared<FinishedMap>();
  map->id = id;
  map->ended = time_at_s(id);
  map->cell_size_m = kCell_m;
  CellBitmap free, occupied;
  free.reset({{-2, -2}, {2, 2}});
  occupied.reset({{-2, -2}, {2, 2}});
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      const CellIndex cell{low.x + static_cast<int>(c), low.y + static_cast<int>(rows.size() - 1 - r)};
      if (rows[r][c] == '.') free.set(cell);
      if (rows[r][c] == '#') occupied.set(cell);
    }
  }
  map->free = TiledBitmap(free);
  map->occupied = TiledBitmap(occupied);
  return map;
}

/// A global map and the grid that shows it, as a robot has them.
class ShownMap {
 public:
  GlobalMap map{kCell_m};

  const ChunkedGrid& grid() {
    EXPECT_EQ(map.redraw(kAll), 0U);
    return published();
  }
  /// As far as it is drawn.
  const ChunkedGrid& published() {
    for (const DrawnChunk& c : map.publish()) grid_.show(c.index, c.free, c.occupied);
    return grid_;
  }
  Rows picture(int width = 40, int height = 30, CellIndex low = {}) {
    return drawing_of(grid(), low, width, height);
  }

 private:
  ChunkedGrid grid_{kCell_m, 4096};
};

int count_of(const Rows& rows, char kind) {
  int n = 0;
  for (const std::string& row : rows) n += static_cast<int>(std::count(row.begin(), row.end(), kind));
  return n;
}

TEST(GlobalMap, ShowsAMapWhereItIsAndMovesIt) {
  ShownMap shown;
  shown.map.place(drawn(0, room()), {});
  EXPECT_EQ(shown.picture(), room());
  EXPECT_EQ(count_of(shown.picture(200, 200, {-80, -80}), ' '), 200 * 200 - 40 * 30) << "and nothing else";
  shown.map.move({{0, Pose2{1.4, -0.5, 0}}, {7, Pose2{}}});
  EXPECT_EQ(shown.picture(40, 30, {70, -25}), room());
  EXPECT_EQ(count_of(shown.picture(200, 200, {-80, -80}), ' '), 200 * 200 - 40 * 30) << "once, not twice";
}

TEST(GlobalMap, ShowsAMapThatWasDrawnInAnotherFrame) {
  ShownMap shown;
  auto map = std::make_shared<FinishedMap>(*drawn(0, room(), {-20, -10}));
  map->drawn_T_origin = {-0.4, -0.2, 0};
  shown.map.place(map, {0.2, 0.6, 0});
  EXPECT_EQ(shown.picture(40, 30, {10, 30}), room());
}

TEST(GlobalMap, TurnsAMapWithItsOrigin) {
  ShownMap shown;
  shown.map.place(drawn(0, with_box(room(), 4, 4, 9)), {0, 0, radians(90)});
  const Rows upright = with_box(room(30, 40), 30 - 4 - 9, 4, 9);
  EXPECT_EQ(shown.picture(30, 40, {-30, 0}), upright);
}

TEST(GlobalMap, WallsAreClosedAtAnyTurn) {
  for (const double degrees : {10.0, 30.0, 45.0, 200.0}) {
    ShownMap shown;
    const Pose2 pose{0.313, 0.107, radians(degrees)};
    shown.map.place(drawn(0, room()), pose);
    const ChunkedGrid& grid = shown.grid();
    for (int y = -120; y < 120; ++y) {
      for (int x = -120; x < 120; ++x) {
        if (grid.state({x, y}) != CellState::kFree) continue;
        const Vector2 at = pose.inverse() * cell_centre({x, y}, kCell_m) / kCell_m;
        ASSERT_TRUE(at.x() > 1 && at.x() < 39 && at.y() > 1 && at.y() < 29) << degrees;
        for (const CellIndex beside : {CellIndex{x + 1, y}, {x - 1, y}, {x, y + 1}, {x, y - 1}})
          ASSERT_NE(grid.state(beside), CellState::kUnknown) << degrees << ": " << x << " " << y;
      }
    }
    EXPECT_EQ(grid.state(cell_at(pose * Vector2(0.4, 0.3), kCell_m)), CellState::kFree);
  }
}

TEST(GlobalMap, TheNewerMapHasTheWord) {
  ShownMap shown;
  shown.map.place(drawn(0, with_box(room(), 5, 10, 10)), {});
  EXPECT_EQ(shown.picture(), with_box(room(), 5, 10, 10));
  shown.map.place(drawn(1, room()), {});
  EXPECT_EQ(shown.picture(), room()) << "the box was taken away";
  shown.map.place(drawn(2, with_box(room(), 25, 4, 9)), {});
  EXPECT_EQ(shown.picture(), with_box(room(), 25, 4, 9))
      << "and another put there; what was free in it is not";
}

TEST(GlobalMap, ANewerMapThatSawLessTakesNothingAway) {
  ShownMap shown;
  shown.map.place(drawn(0, with_box(room(), 25, 10, 9)), {});
  shown.map.place(drawn(1, Rows(10, std::string(12, '.')), {5, 5}), {});
  EXPECT_EQ(shown.picture(), with_box(room(), 25, 10, 9));
}

TEST(GlobalMap, AWallSeenAgainSomeCellsOffIsOneWall) {
  for (const std::size_t off : {1U, 2U, 3U}) {
    ShownMap nearer, farther;
    nearer.map.place(drawn(0, room(40)), {});
    nearer.map.place(drawn(1, room(40 - off)), {});
    Rows narrow = room(40 - off);
    for (std::string& row : narrow) row += std::string(off, ' ');
    EXPECT_EQ(nearer.picture(), narrow) << off << ": the older wall behind it goes, and the gap";
    farther.map.place(drawn(0, room(40 - off)), {});
    farther.map.place(drawn(1, room(40)), {});
    EXPECT_EQ(farther.picture(), room(40)) << off << ": the older wall was looked through";
  }
}

TEST(GlobalMap, TheRoomBehindADoorThatIsNowShutStays) {
  ShownMap shown;
  Rows open = room(80);
  for (std::size_t r = 0; r < 30; ++r) open[r][39] = r > 10 && r < 20 ? '.' : '#';
  shown.map.place(drawn(0, open), {});
  EXPECT_EQ(shown.picture(80), open);
  shown.map.place(drawn(1, room(40)), {});
  const Rows picture = shown.picture(80);
  EXPECT_EQ(part_of(picture, 0, 40), room(40));
  EXPECT_EQ(part_of(picture, 42, 38), part_of(open, 42, 38));
  for (std::size_t r = 1; r < 29; ++r) EXPECT_EQ(picture[r].substr(40, 2), "..");
}

TEST(GlobalMap, DrawsNoMoreBlocksThanAllowed) {
  GlobalMap map(kCell_m);
  map.place(drawn(0, room(120, 60)), {});
  EXPECT_EQ(map.waiting_blocks(), 8U);
  EXPECT_EQ(map.redraw(0), 8U);
  EXPECT_EQ(map.redraw(1), 7U);
  EXPECT_EQ(map.redraw(5), 2U);
  EXPECT_EQ(map.redraw(kAll), 0U);
  EXPECT_EQ(map.redraw(1), 0U);
}

TEST(GlobalMap, BlocksWaitTheirTurn) {
  ShownMap shown;
  shown.map.place(drawn(0, room(32, 32)), {});
  shown.map.place(drawn(1, room(32, 32), {64, 0}), {});
  EXPECT_EQ(shown.map.redraw(1), 1U);
  EXPECT_EQ(shown.published().state({70, 10}), CellState::kUnknown);
  shown.map.place(drawn(2, room(32, 32)), {});  // where the first is changes again
  EXPECT_EQ(shown.map.redraw(1), 1U);
  EXPECT_EQ(shown.published().state({70, 10}), CellState::kFree);
}

TEST(GlobalMap, ABlockThatWaitsIsNotQueuedAgain) {
  GlobalMap map(kCell_m);
  for (std::uint32_t id = 0; id < 20; ++id) map.place(drawn(id, room(32, 32)), {});
  EXPECT_EQ(map.waiting_blocks(), 1U);
}

TEST(GlobalMap, WhatItKeepsDependsOnTheRoomAndNotOnTheHours) {
  std::mt19937 random(3);
  const auto unit = [&] { return 1e-6 * static_cast<double>(random() % 2000001) - 1.0; };
  ShownMap shown;
  std::set<std::uint32_t> retired;
  std::size_t most_names = 0, most_active = 0;
  for (std::uint32_t id = 0; id < 100; ++id) {
    shown.map.place(drawn(id, room(60, 60)), {0.02 * unit(), 0.02 * unit(), 0.005 * unit()});
    shown.map.redraw(kAll);
    for (const std::uint32_t gone : shown.map.retire(id)) EXPECT_TRUE(retired.insert(gone).second) << gone;
    most_names = std::max(most_names, shown.map.names());
    most_active = std::max(most_active, shown.map.active());
  }
  EXPECT_EQ(shown.map.active() + retired.size(), 100U);
  EXPECT_LE(most_active, 8U);
  EXPECT_LE(most_names, 6 * shown.map.blocks());
  EXPECT_EQ(shown.grid().state({30, 30}), CellState::kFree);
}

TEST(GlobalMap, RetiresWhatNothingShowsOnceAndNothingNewerThanWhatIsToBeKept) {
  GlobalMap map(kCell_m);
  for (std::uint32_t id = 0; id < 4; ++id) map.place(drawn(id, room()), {});
  EXPECT_THAT(map.retire(4), IsEmpty()) << "nothing is drawn yet";
  map.redraw(kAll);
  EXPECT_THAT(map.retire(1), ElementsAre(0U));
  EXPECT_THAT(map.retire(1), IsEmpty());
  EXPECT_THAT(map.retire(9), ElementsAre(1U, 2U)) << "the newest shows";
  EXPECT_EQ(map.active(), 1U);
  EXPECT_EQ(map.names(), map.blocks());
}

TEST(GlobalMap, TakesAMapOutAgain) {
  ShownMap shown;
  shown.map.place(drawn(0, room()), {});
  shown.map.place(drawn(1, with_box(room(), 5, 10, 10)), {});
  shown.map.remove(1);
  shown.map.remove(77);
  EXPECT_EQ(shown.picture(), room());
  shown.map.remove(0);
  EXPECT_EQ(count_of(shown.picture(), ' '), 40 * 30);
  EXPECT_EQ(shown.map.active(), 0U);
  EXPECT_EQ(shown.map.blocks(), 0U);
}

TEST(GlobalMap, AMapPlacedForNowTakesNothingFromOthers) {
  ShownMap shown;
  shown.map.place(drawn(0, room()), {});
  EXPECT_EQ(shown.picture(), room());
  shown.map.place_for_now(drawn(1, with_box(room(), 5, 10, 10)), {});
  EXPECT_EQ(shown.picture(), with_box(room(), 5, 10, 10));
  EXPECT_THAT(shown.map.retire(1), IsEmpty()) << "the older still has its names";
  shown.map.remove(1);
  EXPECT_EQ(shown.picture(), room());
}

TEST(GlobalMap, KnowsWhenAPlaceWasSeenLast) {
  GlobalMap map(kCell_m);
  map.place(drawn(3, room(100, 30)), {});
  map.place(drawn(8, Rows(20, std::string(20, '.')), {5, 5}), {});
  map.redraw(kAll);
  EXPECT_EQ(map.last_seen({10, 10}), time_at_s(8));
  EXPECT_EQ(map.last_seen({80, 10}), time_at_s(3));
  EXPECT_EQ(map.last_seen({-200, 10}), std::nullopt);
}

TEST(GlobalMap, PublishesOnlyWhatChanged) {
  GlobalMap map(kCell_m);
  const auto chunks = [&] {
    map.redraw(kAll);
    std::vector<ChunkIndex> indices;
    for (const DrawnChunk& c : map.publish()) indices.push_back(c.index);
    return indices;
  };
  map.place(drawn(0, room(120, 60)), {});
  EXPECT_THAT(chunks(), ElementsAre(ChunkIndex{0, 0}, ChunkIndex{1, 0}));
  EXPECT_THAT(chunks(), IsEmpty());
  map.place(drawn(1, room(120, 60)), {});
  EXPECT_THAT(chunks(), IsEmpty()) << "drawn again, the same";
  map.place(drawn(2, with_box(room(120, 60), 80, 20, 10)), {});
  EXPECT_THAT(chunks(), ElementsAre(ChunkIndex{1, 0}));
}

TEST(GlobalMap, WaitsForMovesOfLessThanAQuarterOfACell) {
  ShownMap shown;
  shown.map.place(drawn(0, room()), {});
  shown.picture();
  shown.map.move({{0, Pose2{0.004, 0, 0}}});
  shown.map.move({{0, Pose2{0, 0, 0.0008}}});
  EXPECT_EQ(shown.map.waiting_blocks(), 0U);
  shown.map.move({{0, Pose2{0.008, 0, 0}}});  // now it has come far enough from where it is drawn
  EXPECT_GT(shown.map.waiting_blocks(), 0U);
  shown.picture();
  shown.map.move({{0, Pose2{0.008, 0, 0.0015}}});
  EXPECT_GT(shown.map.waiting_blocks(), 0U) << "a small turn moves what is far";
}

}  // namespace
}  // namespace dynslam
