// SPDX-License-Identifier: MIT
#include "autopilot/frontier.h"

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "autopilot/drawn_frontiers.h"

namespace dynslam {
namespace {

constexpr double kCell_m = 0.02;

/// In the order that find_frontiers asks for.
std::vector<CellIndex> row_by_row(std::vector<CellIndex> cells) {
  std::sort(cells.begin(), cells.end(),
            [](CellIndex a, CellIndex b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return cells;
}

/// Cells in a line, `step` from one to the next.
std::vector<CellIndex> line(CellIndex from, CellIndex step, int n) {
  std::vector<CellIndex> cells;
  for (int i = 0; i < n; ++i) cells.push_back({from.x + i * step.x, from.y + i * step.y});
  return cells;
}

std::vector<Frontier> find(const std::vector<std::vector<CellIndex>>& lines,
                           const ExplorationConfig& config = {}) {
  std::vector<CellIndex> all;
  for (const auto& l : lines) all.insert(all.end(), l.begin(), l.end());
  return find_frontiers(row_by_row(all), kCell_m, config);
}

/// What is far apart stays apart, and nothing is too long or too small.
ExplorationConfig everything() {
  ExplorationConfig config;
  config.least_length_m = config.least_extent_m = 0.0;
  config.most_extent_m = 100.0;
  config.merge_within_m = 0.0;
  return config;
}

TEST(Frontiers, AOneMetreDoorIntoTheUnknownIsOne) {
  for (const double cell_size_m : {0.02, 0.05, 0.1}) {
    const auto found =
        frontiers_of({"########################", "#......................#", "#......................#",
                      "#......................#", "#......................#", "#......................#",
                      "#######..........#######"},
                     cell_size_m);
    ASSERT_EQ(found.size(), 1U) << cell_size_m;
    EXPECT_NEAR(found[0].middle_map.x(), 1.2, 0.06);
    EXPECT_NEAR(found[0].middle_map.y(), 0.0, cell_size_m);
    EXPECT_NEAR(found[0].extent_m, 1.0, 0.05);
    EXPECT_EQ(found[0].cells, static_cast<std::size_t>(1.0 / cell_size_m + 0.5));
  }
}

TEST(Frontiers, AreNotWhereWallsAreAllRound) {
  EXPECT_TRUE(frontiers_of({"##########",  //
                            "#........#",  //
                            "#........#",  //
                            "##########"})
                  .empty());
}

TEST(Frontiers, AreNotPocketsBehindThings) {
  for (const double cell_size_m : {0.02, 0.05, 0.1}) {
    EXPECT_TRUE(frontiers_of({"################",  //
                              "#..............#",  //
                              "#....#####.....#",  //
                              "#....#   #.....#",  //
                              "#....#   #.....#",  //
                              "#....#   #.....#",  //
                              "#....#####.....#",  //
                              "#..............#",  //
                              "################"},
                             cell_size_m)
                    .empty());
  }
}

TEST(Frontiers, AreNotPocketsIntoWhichOneSeesThroughGaps) {
  EXPECT_TRUE(frontiers_of({"################",  //
                            "#..............#",  //
                            "#....##.##.....#",  //
                            "#....#   #.....#",  //
                            "#.......        ",  //
                            "#....#   #.....#",  //
                            "#....##.##.....#",  //
                            "#..............#",  //
                            "################"},
                           0.02)
                  .empty());
}

TEST(Frontiers, AreWhereARoomIsSeenThroughADoorThatIsAjar) {
  const auto frontiers_before = [](const std::string& behind) {
    return frontiers_of({"################",  //
                         "#..............#",  //
                         "#..............#",  //
                         "#..............#",  //
                         "#####....#######",  //
                         "    #....#      ",  //
                         behind,              //
                         behind,              //
                         behind,              //
                         behind,              //
                         behind,              //
                         behind},
                        0.02);
  };
  const auto room = frontiers_before("                ");
  ASSERT_EQ(room.size(), 1U);
  EXPECT_NEAR(room[0].middle_map.x(), 0.7, 0.05);
  EXPECT_EQ(room[0].cells, 20U);
  EXPECT_TRUE(frontiers_before("    ##  ##      ").empty()) << "a niche is no room";
}

TEST(Frontiers, AreNotSmallSpotsInTheOpen) {
  for (const double cell_size_m : {0.02, 0.05, 0.1}) {
    EXPECT_TRUE(frontiers_of({"################",  //
                              "#..............#",  //
                              "#......  ......#",  //
                              "#......  ......#",  //
                              "#..............#",  //
                              "#.. .... .. ...#",  //
                              "################"},
                             cell_size_m)
                    .empty());
  }
}

TEST(Frontiers, AreNotAlongWallsThatAreMissedByACellOrTwo) {
  EXPECT_TRUE(frontiers_of({"#### ###########",  //
                            "#              #",  //
                            "#  ........... #",  //
                            "# .............#",  //
                            "# .............#",  //
                            "#              #",  //
                            "########  ######"})
                  .empty());
}

TEST(Frontiers, ThatAreTooShortAreWhatMayBeLeftOfOne) {
  for (const auto& [open, is_found, is_rest] :
       {std::tuple{"####......######", true, false}, std::tuple{"####...#########", true, true},
        std::tuple{"####.###########", false, false}}) {
    FrontierMap map;
    map.update({}, map_of({"                ", "                ", "                ", "                ",
                           "                ", "                ", "                ", open,
                           "#..............#", "#..............#", "################"},
                          0.05));
    const auto found = map.frontiers();
    ASSERT_EQ(found.size(), is_found ? 1U : 0U) << open;
    for (const Frontier& f : found) EXPECT_EQ(f.is_rest, is_rest) << open;
    for (const Frontier& f : map.frontiers(true)) EXPECT_FALSE(f.is_rest) << open;
  }
}

TEST(Frontiers, AreNotAlongARayThatWentThroughAWall) {
  for (const double cell_size_m : {0.02, 0.05}) {
    ChunkedGrid grid(cell_size_m);
    const int side = static_cast<int>(2.0 / cell_size_m);
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) grid.add_miss({i, j});
      for (const CellIndex wall :
           {CellIndex{i, -1}, CellIndex{i, side}, CellIndex{-1, i}, CellIndex{side, i}})
        grid.add_hit(wall), grid.add_hit(wall);
    }
    for (int i = 0; i < 2 * side; ++i) {
      for (int look = 0; look < 10; ++look) grid.add_miss({side + i, side / 2 + i / 3});
    }
    FrontierMap frontiers;
    frontiers.update({}, grid.snapshot());
    EXPECT_TRUE(frontiers.frontiers().empty()) << cell_size_m;
  }
}

TEST(Frontiers, AreWhereTheRobotCouldGoOn) {
  const auto found = frontiers_of({"###########             ",  //
                                   "#..........             ",  //
                                   "#..........             ",  //
                                   "#..........             ",  //
                                   "#..........             ",  //
                                   "#............... .......",  //
                                   "#............... .......",  //
                                   "########################"},
                                  0.05);
  ASSERT_EQ(found.size(), 1U)
      << "one corner, all of it one place; the wedge behind the leg of a chair is none";
}

TEST(Frontiers, LongOnesGiveSeveralTargetsAlongThem) {
  const auto found = find({line({0, 0}, {1, 0}, 400)});  // 8 m
  ASSERT_EQ(found.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].middle_map.x(), 8.0 / 6.0 * static_cast<double>(2 * i + 1), 0.03);
    EXPECT_NEAR(found[i].extent_m, 8.0 / 3.0, 0.05);
  }
  EXPECT_EQ(found[0].cells + found[1].cells + found[2].cells, 400U);
  EXPECT_EQ(find({line({0, 0}, {0, -1}, 400)}).size(), 3U);
  EXPECT_EQ(find({line({0, 0}, {0, -1}, 149)}).size(), 1U);
}

TEST(Frontiers, TheHorizonAllRoundIsCutIntoPlacesOnTheHorizon) {
  std::vector<CellIndex> ring;
  for (const auto& side : {line({-300, -300}, {1, 0}, 600), line({-300, 300}, {1, 0}, 600),
                           line({-300, -299}, {0, 1}, 599), line({300, -300}, {0, 1}, 601)})
    ring.insert(ring.end(), side.begin(), side.end());
  const auto found = find({ring});
  EXPECT_GE(found.size(), 16U);
  std::size_t cells = 0;
  for (const Frontier& f : found) {
    EXPECT_LE(f.extent_m, 3.0);
    EXPECT_GT(f.middle_map.cwiseAbs().maxCoeff(), 5.9) << "not in the middle of the ring";
    cells += f.cells;
  }
  EXPECT_EQ(cells, ring.size());
}

TEST(Frontiers, PiecesOfOnePlaceAreOne) {
  // Three pieces of 0.24 m, 4 cells apart: each too small alone.
  const auto found = find({line({0, 0}, {1, 0}, 12), line({16, 1}, {1, 0}, 12), line({32, 0}, {1, 0}, 12)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].cells, 36U);
  EXPECT_TRUE(find({line({0, 0}, {1, 0}, 12), line({40, 0}, {1, 0}, 12)}).empty())
      << "far apart they are noise";
}

TEST(Frontiers, NearOnesAreOneOnlyWhileTheyAreOnePlace) {
  const auto pair = [](int length) {
    return find({line({0, 0}, {1, 0}, length), line({length + 5, 0}, {1, 0}, length)});
  };
  EXPECT_EQ(pair(60).size(), 1U) << "2.5 m together";
  EXPECT_EQ(pair(100).size(), 2U) << "4.1 m together";
}

TEST(Frontiers, OneInsideOfAnothersRectangleIsPartOfIt) {
  std::vector<CellIndex> corner = line({0, 0}, {1, 0}, 80);
  const auto upright = line({0, 1}, {0, 1}, 79);
  corner.insert(corner.end(), upright.begin(), upright.end());
  EXPECT_EQ(find({corner, line({30, 30}, {1, 0}, 30)}).size(), 1U);
}

TEST(Frontiers, AreAsManyAsThereArePatchesThatTouch) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 50; ++trial) {
    std::set<CellIndex> cells;
    for (int i = 0; i < 150; ++i)
      cells.insert({static_cast<int>(random() % 30) - 15, static_cast<int>(random() % 30) - 15});
    std::vector<std::size_t> expected;
    for (std::set<CellIndex> left = cells; !left.empty();) {
      std::vector<CellIndex> patch{*left.begin()};
      left.erase(left.begin());
      for (std::size_t i = 0; i < patch.size(); ++i) {
        for (int k = 0; k < 9; ++k) {
          const CellIndex near{patch[i].x + k % 3 - 1, patch[i].y + k / 3 - 1};
          if (left.erase(near) > 0) patch.push_back(near);
        }
      }
      expected.push_back(patch.size());
    }
    ExplorationConfig config = everything();
    config.merge_within_m = -1000.0;
    std::vector<std::size_t> found;
    for (const Frontier& f : find({{cells.begin(), cells.end()}}, config)) {
      found.push_back(f.cells);
      EXPECT_TRUE(cells.contains(cell_at(f.middle_map, kCell_m))) << "the middle is a frontier cell";
    }
    EXPECT_THAT(found, testing::UnorderedElementsAreArray(expected));
  }
}

TEST(Frontiers, TheMiddleOfAnArcLiesOnIt) {
  std::vector<CellIndex> arc = line({0, 0}, {1, 1}, 30);
  const auto back = line({29, 30}, {-1, 1}, 30);
  arc.insert(arc.end(), back.begin(), back.end());
  const auto found = find({arc});
  ASSERT_EQ(found.size(), 1U);
  const CellIndex middle = cell_at(found[0].middle_map, kCell_m);
  EXPECT_NE(std::find(arc.begin(), arc.end(), middle), arc.end());
}

TEST(Frontiers, OfNothingAreNone) { EXPECT_TRUE(find_frontiers({}, kCell_m, {}).empty()); }

}  // namespace
}  // namespace dynslam
