// SPDX-License-Identifier: MIT
#include "plan/costmap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "plan/drawn_floor.h"

namespace dynslam {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

std::uint8_t clearance_by_force(const Costmap& map, CellIndex c) {
  const int reach = static_cast<int>(Costmap::kReach_m / map.cell_size_m());
  double least_m = Costmap::kReach_m;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const CellIndex at{c.x + dx, c.y + dy};
      if (map.is_occupied(at) || map.is_forbidden(at))
        least_m = std::min(least_m, std::sqrt(dx * dx + dy * dy) * map.cell_size_m());
    }
  }
  return static_cast<std::uint8_t>(std::floor(least_m / kClearanceStep_m + 1e-6));
}

template <class Visit>
void for_each_cell(const ChunkBox& box, Visit&& visit) {
  const CellIndex low = first_cell(box.min), end = first_cell({box.max.x + 1, box.max.y + 1});
  for (int y = low.y; y < end.y; ++y) {
    for (int x = low.x; x < end.x; ++x) visit(CellIndex{x, y});
  }
}

void expect_same(const Costmap& a, const Costmap& b) {
  ASSERT_EQ(a.box().min, b.box().min);
  ASSERT_EQ(a.box().max, b.box().max);
  int differ = 0;
  for_each_cell(a.box(), [&](CellIndex c) {
    const CoarseCell &p = a.coarse()[a.coarse().index_of(c)], &q = b.coarse()[b.coarse().index_of(c)];
    differ += a.clearance_steps(c) != b.clearance_steps(c) || a.is_known(c) != b.is_known(c) ||
              a.is_forbidden(c) != b.is_forbidden(c) || p.clearance != q.clearance || p.about != q.about;
  });
  EXPECT_EQ(differ, 0);
}

CellIndex random_cell(std::mt19937& random, int low, int high) {
  std::uniform_int_distribution<int> at(low, high);
  return {at(random), at(random)};
}

TEST(Costmap, ClearanceIsTheDistanceToTheNearestOccupiedCell) {
  for (const double cell_m : {0.02, 0.05, 0.012}) {
    std::mt19937 random(3);
    for (const int posts : {1, 5, 40}) {
      ChunkedGrid grid(cell_m);
      for (int i = 0; i < posts; ++i) {
        const CellIndex c = random_cell(random, -90, 90);
        for (int look = 0; look < 3; ++look) grid.add_hit(c);
      }
      grid.add_miss({100, 100});
      Costmap map(cell_m);
      map.update(grid.snapshot());
      for (int i = 0; i < 300; ++i) {
        const CellIndex c = random_cell(random, -100, 100);
        if (!map.contains(c)) continue;
        ASSERT_EQ(map.clearance_steps(c), clearance_by_force(map, c)) << c.x << ", " << c.y;
      }
    }
  }
}

TEST(Costmap, TinyCellsHaveAShorterReach) {
  ChunkedGrid grid(0.005);
  for (int look = 0; look < 3; ++look) grid.add_hit({0, 0});
  grid.add_miss({400, 10});
  Costmap map(0.005);
  map.update(grid.snapshot());
  EXPECT_NEAR(map.clearance_m({0.5 + 0.0025, 0.0025}), 0.5, 0.0041);
  EXPECT_NEAR(map.clearance_m({1.5, 0.0025}), 0.9, 0.0041);
}

TEST(Costmap, AnUpdateGivesWhatStartingAnewGives) {
  std::mt19937 random(11);
  DrawnFloor floor;
  Costmap kept(kCell_m);
  for (int turn = 0; turn < 9; ++turn) {
    for (int i = 0; i < 30; ++i) floor.set(random_cell(random, -40 * turn, 25 * turn), i % 3 == 0);
    if (turn % 4 == 1) {
      const Vector2 at = cell_centre(random_cell(random, -100, 100), kCell_m);
      kept.set_forbidden(
          std::vector<std::vector<Vector2>>{{at, at + Vector2(1, 0.3), at + Vector2(0.2, 0.9)}});
      Costmap anew(kCell_m);
      anew.set_forbidden(
          std::vector<std::vector<Vector2>>{{at, at + Vector2(1, 0.3), at + Vector2(0.2, 0.9)}});
      anew.update(floor.grid.snapshot());
      kept.update(floor.grid.snapshot());
      expect_same(kept, anew);
      kept.set_forbidden({});
    }
    kept.update(floor.grid.snapshot());
    expect_same(kept, floor.costmap());
  }
}

TEST(Costmap, OnlyWhatAChangeReachesIsComputedAnew) {
  DrawnFloor floor;
  floor.clear(0, 0, 10, 10);
  Costmap map(kCell_m);
  EXPECT_GT(map.update(floor.grid.snapshot()), 60U);
  EXPECT_EQ(map.update(floor.grid.snapshot()), 0U);
  floor.clear(0, 0, 10, 10);
  EXPECT_EQ(map.update(floor.grid.snapshot()), 0U) << "all bytes changed at most, no state did";
  floor.set({32 + 2 * 64, 32 + 2 * 64}, true);
  EXPECT_EQ(map.update(floor.grid.snapshot()), 9U);
  floor.set({10 + 4 * 64, 60 + 4 * 64}, true);
  EXPECT_EQ(map.update(floor.grid.snapshot()), 4U) << "near the upper left corner of its chunk";
  floor.set({10 + 4 * 64, 60 + 4 * 64}, false);
  EXPECT_EQ(map.update(floor.grid.snapshot()), 4U);
  EXPECT_EQ(map.clearance_m({5.3, 6.4}), Costmap::kReach_m);
}

TEST(Costmap, SaysWhatAPointIs) {
  DrawnFloor floor = floor_of({"##########",  //
                               "#......   ",  //
                               "#......   "});
  const Costmap map = floor.costmap();
  EXPECT_EQ(map.state({0.05, 0.05}), CellState::kOccupied);
  EXPECT_EQ(map.state({0.35, 0.05}), CellState::kFree);
  EXPECT_EQ(map.state({0.85, 0.05}), CellState::kUnknown);
  EXPECT_EQ(map.clearance_m({0.05, 0.05}), 0.0);
  EXPECT_NEAR(map.clearance_m({0.15, 0.05}), 0.06, 0.004) << "from the middle of the wall's last cell";
  for (const Vector2& nowhere : {Vector2(-50, 3), Vector2(1e300, 0), Vector2(0, -kInf), Vector2(kNan, 0)}) {
    EXPECT_EQ(map.state(nowhere), CellState::kUnknown);
    EXPECT_EQ(map.clearance_m(nowhere), nowhere.allFinite() ? Costmap::kReach_m : 0.0);
  }
  EXPECT_EQ(Costmap(kCell_m).state({0, 0}), CellState::kUnknown);
  EXPECT_EQ(Costmap(kCell_m).update({}), 0U);
}

TEST(Costmap, CountsACoarseCellAsKnownWhenHalfOfItIs) {
  DrawnFloor floor;
  for (int i = 0; i < 8; ++i) floor.set({i % 4, i / 4}, false);
  for (int i = 0; i < 7; ++i) floor.set({8 + i % 4, i / 4}, false);
  const Costmap map = floor.costmap();
  EXPECT_TRUE(map.coarse()[map.coarse().index_of({3, 3})].known());
  EXPECT_FALSE(map.coarse()[map.coarse().index_of({8, 0})].known());
}

TEST(Costmap, ANoGoAreaCountsAsOccupiedUntilItIsTakenAway) {
  DrawnFloor floor;
  floor.clear(0, 0, 4, 4);
  Costmap map = floor.costmap();
  const std::vector<std::vector<Vector2>> areas{{{1, 1}, {2, 1}, {2, 2}, {1, 2}}};
  map.set_forbidden(areas);
  EXPECT_EQ(map.state({1.5, 1.5}), CellState::kFree) << "not yet";
  EXPECT_GT(map.update(floor.grid.snapshot()), 0U) << "though the map is as it was";
  EXPECT_EQ(map.state({1.5, 1.5}), CellState::kOccupied);
  EXPECT_TRUE(map.is_forbidden({75, 75}));
  EXPECT_TRUE(map.is_forbidden({50, 50}));
  EXPECT_FALSE(map.is_forbidden({49, 50}));
  EXPECT_FALSE(map.is_forbidden({100, 75}));
  EXPECT_FALSE(map.is_occupied({75, 75}));
  EXPECT_NEAR(map.clearance_m({2.51, 1.51}), 0.52, 0.004);
  map.set_forbidden({});
  map.update(floor.grid.snapshot());
  EXPECT_EQ(map.state({1.5, 1.5}), CellState::kFree);
  EXPECT_EQ(map.clearance_m({1.5, 1.5}), Costmap::kReach_m);
}

TEST(Costmap, ANoGoAreaHoldsTheCellsInsideOfIt) {
  DrawnFloor floor;
  floor.clear(0, 0, 2.5, 2.5);
  Costmap map = floor.costmap();
  const std::vector<Vector2> star{
      {0.201, 0.303}, {2.217, 0.509}, {1.311, 1.013}, {1.903, 2.331}, {0.927, 1.409}};
  map.set_forbidden(std::vector<std::vector<Vector2>>{star});
  map.update(floor.grid.snapshot());
  const auto is_inside = [&](const Vector2& p) {
    bool inside = false;
    for (std::size_t i = 0; i < star.size(); ++i) {
      const Vector2 a = star[i] - p, b = star[(i + 1) % star.size()] - p;
      if ((a.y() > 0) != (b.y() > 0)) inside ^= (a.x() * b.y() - a.y() * b.x() > 0) == (b.y() > a.y());
    }
    return inside;
  };
  int differ = 0;
  for_each_cell(map.box(),
                [&](CellIndex c) { differ += map.is_forbidden(c) != is_inside(cell_centre(c, kCell_m)); });
  EXPECT_EQ(differ, 0);
}

TEST(Costmap, HostileOutlinesDoNoHarm) {
  DrawnFloor floor;
  floor.clear(0, 0, 2, 2);
  Costmap map = floor.costmap();
  std::vector<std::vector<Vector2>> areas{{},
                                          {{1, 1}},
                                          {{0, 0}, {1, 1}},
                                          {{0, 0}, {kNan, 1}, {1, 0}},
                                          {{0, 0}, {kInf, 1}, {1, 0}},
                                          {{0, 0}, {0, 0}, {0, 0}},
                                          std::vector<Vector2>(Costmap::kMostCorners + 1, Vector2(1, 1))};
  map.set_forbidden(areas);
  map.update(floor.grid.snapshot());
  for_each_cell(map.box(), [&](CellIndex c) { ASSERT_FALSE(map.is_forbidden(c)); });
  map.set_forbidden(std::vector<std::vector<Vector2>>{{{-1e300, -1e300}, {1e300, -1e300}, {1, 1e300}}});
  map.update(floor.grid.snapshot());
  EXPECT_TRUE(map.is_forbidden({50, 50}));
  EXPECT_FALSE(map.is_forbidden({-50, 5000})) << "outside of the map's box";
}

TEST(Costmap, KeepsItsNoGoAreasWhileTheMapGrows) {
  DrawnFloor floor;
  floor.clear(0, 0, 1, 1);
  Costmap map(kCell_m);
  map.set_forbidden(std::vector<std::vector<Vector2>>{{{5, 5}, {6, 5}, {6, 6}, {5, 6}}});
  map.update(floor.grid.snapshot());
  EXPECT_EQ(map.state({5.5, 5.5}), CellState::kUnknown);
  floor.clear(4, 4, 7, 7);
  map.update(floor.grid.snapshot());
  EXPECT_EQ(map.state({5.5, 5.5}), CellState::kOccupied);
  EXPECT_NEAR(map.clearance_m({4.51, 5.51}), 0.5, 0.004);
}

TEST(Costmap, AMapThatIsTooLargeIsKeptToItsOldBox) {
  DrawnFloor floor;
  floor.clear(0, 0, 1, 1);
  Costmap map = floor.costmap();
  floor.set({100000000, 5}, true);
  floor.set({5, -100000000}, true);
  map.update(floor.grid.snapshot());
  EXPECT_EQ(map.state({0.5, 0.5}), CellState::kFree);
  EXPECT_EQ(map.state({2e6, 0.1}), CellState::kUnknown);
  const Costmap anew = floor.costmap();
  EXPECT_EQ(anew.state({0.5, 0.5}), CellState::kFree);
  EXPECT_LE(anew.box().width() * anew.box().height(), int(Costmap::kMostChunks));
}

}  // namespace
}  // namespace dynslam
