// SPDX-License-Identifier: MIT
#include "slam/clean_up.h"

#include <chrono>
#include <deque>
#include <random>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grid/bitmap_sets.h"
#include "grid/drawn_map.h"
#include "grid/free_space.h"
#include "slam/drawn_world.h"

namespace dynslam {
namespace {

using ::testing::ElementsAre;

constexpr double kCell_m = 0.02;

Vector2 middle_of(CellIndex c) { return cell_centre(c, kCell_m); }

/// A local map with a drawing in it and the robot on one of its cells.
LocalMap drawn(const std::vector<std::string>& rows, CellIndex robot, CellIndex low = {}) {
  const Vector2 at = middle_of(robot);
  LocalMap map(kCell_m, 1000, {at.x(), at.y(), 0.0}, Time{});
  draw(map.grid, rows, low);
  return map;
}

FinishedMap clean(const LocalMap& map) { return clean_up(map, 1, time_at_s(4.0)); }

std::vector<std::string> drawing_of(const FinishedMap& map, CellIndex low, int width, int height) {
  std::vector<std::string> rows;
  for (int y = height - 1; y >= 0; --y) {
    std::string row;
    for (int x = 0; x < width; ++x) {
      const CellIndex c{low.x + x, low.y + y};
      EXPECT_FALSE(map.occupied.test(c) && map.free.test(c));
      row += map.occupied.test(c) ? '#' : map.free.test(c) ? '.' : ' ';
    }
    rows.push_back(row);
  }
  return rows;
}

/// A local map of what a lidar saw of a world from some places, so many scans from each.
LocalMap seen(const DrawnWorld& world, const std::vector<Vector2>& places, int scans, double noise_m = 0.01) {
  LocalMap map(kCell_m, 10000, {places.front().x(), places.front().y(), 0.5}, Time{});
  std::mt19937 random(3);
  FreeSpace free_space;
  for (int i = 0; i < scans * static_cast<int>(places.size()); ++i) {
    const Vector2& at = places[static_cast<std::size_t>(i) % places.size()];
    const Pose2 pose{at.x(), at.y(), 0.01 * i};
    const Scan scan = look(
        world, Time{}, [&](Time) { return pose; }, {.turn_s = 0.0, .noise_m = noise_m}, random);
    std::vector<RayEnd> ends;
    for (const Beam& b : scan.beams) {
      if (!std::isfinite(b.range_m)) continue;
      ends.push_back({b.range_m * std::cos(b.angle_rad), b.range_m * std::sin(b.angle_rad), b.angle_rad,
                      b.range_m, true});
    }
    map.grid.apply(free_space.trace(pose, ends, 0.05, kCell_m));
    map.robot_positions.push_back(at);
  }
  return map;
}

int occupied_in(const FinishedMap& map, CellIndex low, CellIndex high) {
  int n = 0;
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) n += map.occupied.test({x, y}) ? 1 : 0;
  }
  return n;
}

TEST(CleanUp, DropsWhatLiesBehindAWall) {
  const LocalMap map = drawn({"    # #   .. ",  //
                              "             ",  //
                              "             ",  //
                              "#############",  //
                              ".............",  //
                              "............."},
                             {2, 0});
  EXPECT_THAT(drawing_of(clean(map), {0, 0}, 13, 6),
              ElementsAre("             ",  //
                          "             ",  //
                          "             ",  //
                          "#############",  //
                          "  .........  ",  //
                          "  .........  "))
      << "and free space before all of it but the ends";
}

TEST(CleanUp, MakesThickOutlinesThin) {
  const FinishedMap map = clean(drawn({"###############",  //
                                       "###############",  //
                                       "###############",  //
                                       "...............",  //
                                       "..............."},
                                      {7, 0}));
  EXPECT_EQ(occupied_in(map, {3, 3}, {11, 3}), 9);
  EXPECT_LE(map.occupied.count(), 17U) << "but for the wall's ends";
  EXPECT_TRUE(map.free.test({7, 2})) << "what lay before the middle of the wall was passed";
  EXPECT_FALSE(map.free.test({7, 4}));
}

TEST(CleanUp, WallSeenTwiceTwoCellsApartIsOne) {
  const FinishedMap map = clean(drawn({"###############",  //
                                       "               ",  //
                                       "###############",  //
                                       "...............",  //
                                       "..............."},
                                      {7, 0}));
  EXPECT_EQ(occupied_in(map, {2, 3}, {12, 3}), 11) << "all but the ends";
  EXPECT_LE(map.occupied.count(), 17U) << "but for the wall's ends";
}

TEST(CleanUp, KeepsPostsAndWhatIsSeenBetweenThem) {
  const LocalMap map = drawn({"#################",  //
                              ".................",  //
                              ".................",  //
                              ".................",  //
                              "##...##...##...##",  //
                              ".................",  //
                              ".................",  //
                              "................."},
                             {9, 0});
  const FinishedMap cleaned = clean(map);
  EXPECT_EQ(occupied_in(cleaned, {0, 7}, {16, 7}), 17);
  EXPECT_TRUE(cleaned.free.test({9, 5}));
  for (int x = 0; x < 17; x += 5) EXPECT_GE(occupied_in(cleaned, {x, 3}, {x + 1, 3}), 1) << x;
  for (int x = 2; x < 17; x += 5) EXPECT_EQ(occupied_in(cleaned, {x, 3}, {x + 2, 3}), 0) << x;
}

/// A row of so many hits and misses a cell, over free space that the robot is in.
LocalMap wall_of(const std::vector<std::pair<int, int>>& hits_and_misses) {
  const int width = static_cast<int>(hits_and_misses.size());
  LocalMap map = drawn(std::vector<std::string>(8, std::string(hits_and_misses.size(), '.')), {width / 2, 1});
  LocalMap wall(kCell_m, 100, map.map_T_origin, Time{});
  for (int x = 0; x < width; ++x) {
    const auto [hits, misses] = hits_and_misses[static_cast<std::size_t>(x)];
    for (int i = 0; i < hits; ++i) wall.grid.add_hit({x, 6});
    for (int i = 0; i < misses; ++i) wall.grid.add_miss({x, 6});
    for (int y = 0; y < 4; ++y) {
      for (int i = 0; i < 20; ++i) wall.grid.add_miss({x, y});
    }
  }
  return wall;
}

TEST(CleanUp, FaintSurfacesAreDrawnBetweenClearOnesOnly) {
  const std::pair<int, int> clear(12, 0), faint(2, 0);
  std::vector<std::pair<int, int>> cells(10, clear);
  cells.insert(cells.end(), 4, faint);
  cells.insert(cells.end(), 10, clear);
  cells.insert(cells.end(), 10, faint);
  const FinishedMap map = clean(wall_of(cells));
  EXPECT_EQ(occupied_in(map, {2, 6}, {22, 6}), 21);
  EXPECT_EQ(occupied_in(map, {26, 6}, {33, 6}), 0);
  EXPECT_EQ(occupied_in(map, {0, 0}, {40, 5}), 0);
}

TEST(CleanUp, KeepsALegOfTwoByTwoCells) {
  const FinishedMap map = clean(drawn({"........",  //
                                       "........",  //
                                       "...##...",  //
                                       "...##...",  //
                                       "........",  //
                                       "........"},
                                      {0, 0}));
  EXPECT_GE(map.occupied.count(), 1U);
  EXPECT_EQ(map.occupied.count(), static_cast<std::size_t>(occupied_in(map, {3, 2}, {4, 3})));
}

TEST(CleanUp, DiagonalWallsHoldTheFill) {
  std::vector<std::string> rows(24, std::string(24, '.'));
  for (std::size_t i = 0; i < 24; ++i) rows[i][i] = '#';
  const FinishedMap map = clean(drawn(rows, {1, 1}));
  EXPECT_EQ(map.occupied.count(), 24U);
  EXPECT_TRUE(map.free.test({2, 2}));
  EXPECT_FALSE(map.free.test({21, 21})) << "the other side of the wall";
}

TEST(CleanUp, HitsOnceOrTwiceAreNoSurface) {
  LocalMap map = drawn(std::vector<std::string>(20, std::string(20, '.')), {2, 2});
  for (int look = 0; look < 2; ++look) map.grid.add_hit({12, 12});
  EXPECT_EQ(clean(map).occupied.count(), 0U);
}

TEST(CleanUp, OfNothingIsNothing) {
  const LocalMap untouched(kCell_m, 100, {}, Time{});
  EXPECT_EQ(clean(untouched).occupied.count(), 0U);
  const FinishedMap walled_in = clean(drawn({"....", "####", "...."}, {500, 500}));
  EXPECT_EQ(walled_in.occupied.count(), 0U);
  EXPECT_EQ(walled_in.free.count(), 0U);
  EXPECT_TRUE(walled_in.cloud.empty());
}

TEST(CleanUp, IsTheSameAcrossChunkSeams) {
  const DrawnWorld world = two_rooms();
  const std::vector<Vector2> places = {{2.2, 2.4}, {2.6, 2.5}};
  const FinishedMap here = clean(seen(world, places, 20));
  // The same world a few chunks and some cells off, mostly below zero.
  constexpr int kBack = 229;
  const double off = kBack * kCell_m;
  DrawnWorld moved;
  for (const auto& w : world.walls)
    moved.walls.push_back({w.from - Vector2(off, off), w.to - Vector2(off, off)});
  const FinishedMap there = clean(seen(moved, {{2.2 - off, 2.4 - off}, {2.6 - off, 2.5 - off}}, 20));
  ASSERT_GT(here.occupied.count(), 500U);
  int differing = 0;
  for (int y = -10; y < 300; ++y) {
    for (int x = -10; x < 450; ++x) {
      differing += here.occupied.test({x, y}) != there.occupied.test({x - kBack, y - kBack}) ? 1 : 0;
    }
  }
  EXPECT_LT(differing, 30) << "but for rounding";
}

/// A cell next to a hit is never passed: without noise, nothing was ever seen of those before a wall.
TEST(CleanUp, KeepsWallsSeenWithoutNoise) {
  const FinishedMap map = clean(seen(two_rooms(), {{2.2, 2.4}, {2.6, 2.5}}, 20, 0.0));
  EXPECT_EQ(occupied_in(map, {0, 50}, {0, 199}), 150);
  EXPECT_TRUE(map.free.test({1, 100}));
}

/// Walls of the drawn flat, seen with noise, are lines about a cell thick, closed at the corners, in place.
TEST(CleanUp, MakesLinesOfNoisyWalls) {
  const LocalMap raw = seen(two_rooms(), {{2.2, 2.4}, {2.6, 2.5}, {3.0, 2.3}}, 17);
  const FinishedMap map = clean(raw);
  // The wall at x = 0.007 between y = 1 and y = 4: 150 rows.
  const int cells = occupied_in(map, {-4, 50}, {4, 199});
  EXPECT_GE(cells, 145);
  EXPECT_LE(cells, 190);
  EXPECT_GE(occupied_in(map, {-1, -1}, {1, 1}), 1) << "corner";
  int rows_open = 0;
  for (int y = 50; y < 200; ++y) rows_open += occupied_in(map, {-4, y - 1}, {4, y + 1}) == 0 ? 1 : 0;
  EXPECT_EQ(rows_open, 0);
  EXPECT_LT(map.occupied.count(), 2000U);
}

TEST(CleanUp, CloudLiesOnTheWallsInTheOriginsFrame) {
  const LocalMap raw = seen(two_rooms(), {{2.2, 2.4}, {2.6, 2.5}, {3.0, 2.3}}, 17);
  const FinishedMap map = clean(raw);
  ASSERT_EQ(map.cloud.size(), map.occupied.count());
  double error_m = 0.0;
  int n = 0;
  for (const CloudPoint& p : map.cloud) {
    const Vector2 at = map.drawn_T_origin * Vector2(p.x_m, p.y_m);
    if (std::abs(at.x()) > 0.1 || at.y() < 1.0 || at.y() > 4.0) continue;
    error_m += std::abs(at.x() - 0.007);
    ++n;
  }
  ASSERT_GT(n, 100);
  EXPECT_LT(error_m / n, 0.006);
}

TEST(CleanUp, SaysWhichMapItWas) {
  const LocalMap raw = drawn({"...", "..."}, {1, 1});
  const FinishedMap map = clean_up(raw, 7, time_at_s(3.0));
  EXPECT_EQ(map.id, 7U);
  EXPECT_EQ(map.ended, time_at_s(3.0));
  EXPECT_EQ(map.begun, raw.begun);
  EXPECT_EQ(map.drawn_T_origin, raw.map_T_origin);
}

TEST(CleanUp, OfARoomIsQuick) {
  DrawnWorld hall;
  hall.add_box(0.007, 0.011, 12.013, 9.009);
  const LocalMap raw = seen(hall, {{4.0, 4.0}, {5.0, 4.5}}, 25);
  const auto begun = std::chrono::steady_clock::now();
  const FinishedMap map = clean(raw);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begun;
  RecordProperty("milliseconds", std::to_string(took.count()));
  EXPECT_GT(map.occupied.count(), 1800U);
  EXPECT_LT(took.count(), 500.0) << "a bound for slow builds; optimised it is about 1 ms";
}

/// Two sets of random cells, none in both.
struct Cells {
  CellBitmap free, occupied;

  explicit Cells(const ChunkBox& box = {{-1, -1}, {1, 0}}) {
    free.reset(box);
    occupied.reset(box);
  }
  void fill(CellBitmap Cells::*kind, CellIndex low, CellIndex high) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) (this->*kind).set({x, y});
    }
  }
};

/// Whether a square of (2 reach + 1)^2 cells holds none but those of a kind, any of it counted.
bool square_is_full(const CellBitmap& cells, CellIndex middle, int reach) {
  for (int y = middle.y - reach; y <= middle.y + reach; ++y) {
    for (int x = middle.x - reach; x <= middle.x + reach; ++x) {
      if (cells.contains({x, y}) && !cells.test({x, y})) return false;
    }
  }
  return true;
}
bool square_is_empty(const CellBitmap& cells, CellIndex middle, int reach) {
  for (int y = middle.y - reach; y <= middle.y + reach; ++y) {
    for (int x = middle.x - reach; x <= middle.x + reach; ++x) {
      if (cells.test({x, y})) return false;
    }
  }
  return true;
}

/// The cells that so many steps to the sides, none of them onto a surface, lead to.
std::set<CellIndex> within_steps(std::set<CellIndex> cells, const CellBitmap& occupied, int steps) {
  for (int step = 0; step < steps; ++step) {
    const std::set<CellIndex> before = cells;
    for (const CellIndex c : before) {
      for (const CellIndex d : {CellIndex{c.x - 1, c.y}, {c.x + 1, c.y}, {c.x, c.y - 1}, {c.x, c.y + 1}}) {
        if (occupied.contains(d) && !occupied.test(d)) cells.insert(d);
      }
    }
  }
  return cells;
}

/// Cracks are what two steps lead to, and two steps from beyond that do not.
TEST(FillCracks, AgreesWithBruteForce) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 20; ++trial) {
    Cells cells;
    std::set<CellIndex> free, beyond;
    for (int y = -64; y < 64; ++y) {
      for (int x = -64; x < 128; ++x) {
        const auto draw = random() % 100;
        if (draw < 12) cells.free.set({x, y}), free.insert({x, y});
        if (draw >= 85) cells.occupied.set({x, y});
      }
    }
    const std::set<CellIndex> grown = within_steps(free, cells.occupied, 2);
    for (int y = -64; y < 64; ++y) {
      for (int x = -64; x < 128; ++x) {
        if (!grown.contains({x, y}) && !cells.occupied.test({x, y})) beyond.insert({x, y});
      }
    }
    beyond = within_steps(beyond, cells.occupied, 2);
    CellBitmap filled = cells.free;
    fill_cracks(filled, cells.occupied, 4);
    for (int y = -64; y < 64; ++y) {
      for (int x = -64; x < 128; ++x) {
        const CellIndex c{x, y};
        ASSERT_EQ(filled.test(c), free.contains(c) || (grown.contains(c) && !beyond.contains(c)))
            << x << " " << y;
      }
    }
  }
}

TEST(FillCracks, LeavesTheInsideOfASlantingWallAlone) {
  Cells cells({{0, 0}, {0, 0}});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const int off = x - y;
      if (off == 0 || off == 3) cells.occupied.set({x, y});
      if (off < 0 || off > 3) cells.free.set({x, y});
    }
  }
  const std::size_t before = cells.free.count();
  fill_cracks(cells.free, cells.occupied, 4);
  EXPECT_EQ(cells.free.count(), before);
}

TEST(MendWalls, FillsUnknownGapsOfTwoCellsAndNoFreeOnes) {
  for (const int wide : {1, 2, 3}) {
    for (const bool seen_through : {false, true}) {
      Cells cells;
      cells.fill(&Cells::free, {-20, -5}, {20, -1});
      cells.fill(&Cells::occupied, {-20, 0}, {0, 0});
      cells.fill(&Cells::occupied, {wide + 1, 0}, {20, 0});
      if (seen_through) cells.fill(&Cells::free, {1, 0}, {wide, 0});
      const std::size_t before = cells.occupied.count();
      mend_walls(cells.occupied, cells.free);
      EXPECT_EQ(cells.occupied.count() - before, wide <= 2 && !seen_through ? wide : 0) << wide;
    }
  }
}

TEST(FillCracks, FillsFourCellsAndLeavesFive) {
  for (const int wide : {1, 4, 5, 9}) {
    Cells cells;
    cells.fill(&Cells::free, {-20, -20}, {9, 20});
    cells.fill(&Cells::free, {10 + wide, -20}, {50, 20});
    const std::size_t before = cells.free.count();
    fill_cracks(cells.free, cells.occupied, 4);
    const std::size_t filled = cells.free.count() - before;
    EXPECT_LE(filled, wide <= 4 ? 41U * wide : 0U) << wide;
    EXPECT_GE(filled, wide <= 4 ? 37U * wide : 0U) << "but for the ends, where it is open: " << wide;
  }
}

TEST(FillCracks, LeavesSurfacesStanding) {
  Cells cells;
  cells.fill(&Cells::free, {-20, -20}, {9, 20});
  cells.fill(&Cells::occupied, {11, -20}, {11, 20});
  cells.fill(&Cells::free, {13, -20}, {50, 20});
  fill_cracks(cells.free, cells.occupied, 4);
  EXPECT_EQ(cells.occupied.count(), 41U);
  EXPECT_TRUE(cells.free.test({10, 0}));
  EXPECT_FALSE(cells.free.test({11, 0}));
  EXPECT_TRUE(cells.free.test({12, 0}));
}

/// Free cells that steps through free cells lead to from the middle of a square of nine by nine.
std::set<CellIndex> free_that_stays(const Cells& cells) {
  std::deque<CellIndex> queue;
  std::set<CellIndex> reached;
  for (int y = -64; y < 64; ++y) {
    for (int x = -64; x < 128; ++x) {
      if (square_is_full(cells.free, {x, y}, 4)) queue.push_back({x, y});
    }
  }
  while (!queue.empty()) {
    const CellIndex c = queue.front();
    queue.pop_front();
    if (!cells.free.test(c) || !reached.insert(c).second) continue;
    for (const CellIndex d : {CellIndex{c.x - 1, c.y}, {c.x + 1, c.y}, {c.x, c.y - 1}, {c.x, c.y + 1}})
      queue.push_back(d);
  }
  return reached;
}

/// Surfaces beside what one step from free space leads to, and those with none of these within four cells.
std::set<CellIndex> surfaces_that_stay(const Cells& cells, const std::set<CellIndex>& free) {
  Cells found({{-1, -1}, {1, 0}});
  for (const CellIndex c : within_steps(free, cells.occupied, 1)) found.free.set(c);
  std::set<CellIndex> stay;
  const auto each_surface = [&](auto&& visit) {
    for (int y = -64; y < 64; ++y) {
      for (int x = -64; x < 128; ++x) {
        if (cells.occupied.test({x, y})) visit(CellIndex{x, y});
      }
    }
  };
  each_surface([&](CellIndex c) {
    if (!square_is_empty(found.free, c, 1)) found.occupied.set(c), stay.insert(c);
  });
  each_surface([&](CellIndex c) {
    if (square_is_empty(found.occupied, c, 4)) stay.insert(c);
  });
  return stay;
}

TEST(DropGaps, AgreesWithBruteForce) {
  std::mt19937 random(12);
  for (int trial = 0; trial < 20; ++trial) {
    Cells cells;
    for (int y = -64; y < 64; ++y) {
      for (int x = -64; x < 128; ++x) {
        const auto draw = random() % 100;
        if (draw < 55) cells.free.set({x, y});
        if (draw >= 80) cells.occupied.set({x, y});
      }
    }
    for (int room = 0; room < 3; ++room) {
      const CellIndex low{static_cast<int>(random() % 170) - 60, static_cast<int>(random() % 100) - 60};
      const int side = 6 + static_cast<int>(random() % 6);
      cells.fill(&Cells::free, low, {low.x + side, low.y + side});
    }
    take_out(cells.occupied, cells.free);
    const std::set<CellIndex> reached = free_that_stays(cells);
    const std::set<CellIndex> touched = surfaces_that_stay(cells, reached);
    drop_gaps(cells.free, cells.occupied, 8);
    ASSERT_EQ(cells.free.count(), reached.size());
    ASSERT_EQ(cells.occupied.count(), touched.size());
    for (const CellIndex c : reached) ASSERT_TRUE(cells.free.test(c));
    for (const CellIndex c : touched) ASSERT_TRUE(cells.occupied.test(c));
  }
}

TEST(DropGaps, TakesTheOlderWallBehindTheNewerAndTheGap) {
  Cells cells({{0, 0}, {0, 0}});
  cells.fill(&Cells::free, {0, 0}, {63, 19});
  cells.fill(&Cells::occupied, {0, 20}, {63, 20});
  cells.fill(&Cells::free, {0, 21}, {63, 22});
  cells.fill(&Cells::occupied, {0, 23}, {63, 23});
  drop_gaps(cells.free, cells.occupied, 8);
  EXPECT_EQ(cells.occupied.count(), 64U);
  EXPECT_TRUE(cells.occupied.test({30, 20}));
  EXPECT_EQ(cells.free.count(), 64U * 20U);
}

TEST(DropGaps, KeepsWhatIsNarrowButHasAWayToWiderParts) {
  Cells cells;
  cells.fill(&Cells::free, {-60, -60}, {-30, -30});
  cells.fill(&Cells::free, {-29, -40}, {60, -37});  // an alley of four cells out of the room
  cells.fill(&Cells::free, {-60, 0}, {60, 7});      // eight cells, and no way in
  cells.fill(&Cells::free, {-60, 20}, {60, 28});    // nine
  drop_gaps(cells.free, cells.occupied, 8);
  EXPECT_TRUE(cells.free.test({60, -38}));
  EXPECT_FALSE(cells.free.test({0, 4}));
  EXPECT_TRUE(cells.free.test({0, 24})) << "the room behind a door that is shut";
}

}  // namespace
}  // namespace dynslam
