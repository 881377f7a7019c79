// SPDX-License-Identifier: MIT
#include "slam/witness.h"

#include <cmath>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

constexpr double kCell_m = 0.02;

enum class Word { kNothing, kNear, kFree, kOccupied };

/// What a map says of a cell of the global map, looked up point by point.
Word say(const FinishedMap& map, const Pose2& map_T_origin, CellIndex cell) {
  const Pose2 drawn_T_map = map.drawn_T_origin * map_T_origin.inverse();
  const auto drawn_cell = [&](double dx, double dy) {
    return cell_at(drawn_T_map * Vector2((cell.x + 0.5 + dx) * kCell_m, (cell.y + 0.5 + dy) * kCell_m),
                   kCell_m);
  };
  for (const double dx : {-0.25, 0.25}) {
    for (const double dy : {-0.25, 0.25}) {
      if (map.occupied.test(drawn_cell(dx, dy))) return Word::kOccupied;
    }
  }
  const CellIndex middle = drawn_cell(0, 0);
  if (map.free.test(middle)) return Word::kFree;
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      if (std::abs(x) + std::abs(y) <= 2 && map.occupied.test({middle.x + x, middle.y + y}))
        return Word::kNear;
    }
  }
  return Word::kNothing;
}

/// A block as it is when one map after the other has had its say, a cell at a time.
class SlowBlock {
 public:
  SlowBlock(CellIndex first, int side) : first_(first), side_(side) {}

  Testimony hear(const FinishedMap& map, const Pose2& map_T_origin) {
    Testimony added;
    for (int y = 0; y < side_; ++y) {
      for (int x = 0; x < side_; ++x) {
        Cell& cell = cells_[y][x];
        if (cell.shown != Word::kNothing) continue;
        const Word word = say(map, map_T_origin, {first_.x + x, first_.y + y});
        if (word == Word::kFree) {
          cell.shown = word;
          ++added.free;
        }
        if (word == Word::kOccupied && !cell.no_wall) {
          cell.shown = word;
          ++added.occupied;
        }
        cell.no_wall = cell.no_wall || word == Word::kOccupied || word == Word::kNear;
      }
    }
    return added;
  }

  int differing(const BlockView& view) const {
    int n = 0;
    for (int y = 0; y < side_; ++y) {
      for (int x = 0; x < side_; ++x) {
        const auto r = static_cast<std::size_t>(y);
        const bool free = view.free[r] >> x & 1U, occupied = view.occupied[r] >> x & 1U;
        EXPECT_EQ((view.undecided[r] >> x & 1U) == 0, free || occupied);
        EXPECT_FALSE(free && occupied);
        const Word shown = free ? Word::kFree : occupied ? Word::kOccupied : Word::kNothing;
        n += shown != cells_[y][x].shown ? 1 : 0;
      }
    }
    return n;
  }

 private:
  struct Cell {
    Word shown = Word::kNothing;
    bool no_wall = false;
  };
  CellIndex first_;
  int side_;
  Cell cells_[32][32] = {};
};

/// A map of random rectangles of free space and random short walls, anywhere in its frame.
FinishedMap random_map(std::mt19937& random) {
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  CellBitmap free, occupied;
  for (CellBitmap* b : {&free, &occupied}) b->reset({{-2, -2}, {1, 1}});
  const auto fill = [&](CellBitmap& cells, int width, int height) {
    const CellIndex low{below(256 - width) - 128, below(256 - height) - 128};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) cells.set({low.x + x, low.y + y});
    }
  };
  for (int i = 0; i < 40; ++i) fill(free, 1 + below(60), 1 + below(60));
  for (int i = 0; i < 60; ++i) {
    const int length = 1 + below(40);
    fill(occupied, i % 2 ? 1 : length, i % 2 ? length : 1);
  }
  for (int r = 0; r < free.rows(); ++r) {
    for (int w = 0; w < free.words_per_row(); ++w) free.row(r)[w] &= ~occupied.row(r)[w];
  }
  FinishedMap map;
  map.cell_size_m = kCell_m;
  map.free = TiledBitmap(free);
  map.occupied = TiledBitmap(occupied);
  const auto unit = [&] { return 1e-6 * below(2000001) - 1.0; };
  map.drawn_T_origin = {unit(), unit(), kPi * unit()};
  return map;
}

TEST(Witness, SaysWhatLookingAtEachCellSays) {
  std::mt19937 random(7);
  const auto unit = [&] { return 1e-6 * static_cast<double>(random() % 2000001) - 1.0; };
  int cells = 0, differing = 0, differing_counts = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const int side = trial % 3 == 0 ? 8 : trial % 3 == 1 ? 16 : 32;
    const CellIndex first{(static_cast<int>(random() % 8) - 4) * side,
                          (static_cast<int>(random() % 8) - 4) * side};
    BlockView view(first, side);
    SlowBlock slow(first, side);
    for (int newer = 0; newer < 3; ++newer) {
      const FinishedMap map = random_map(random);
      // Now and then just as it was drawn, or turned by a quarter.
      Pose2 pose{unit(), unit(), kPi * unit()};
      if (trial % 5 == 0) pose = map.drawn_T_origin;
      if (trial % 5 == 1) pose = Pose2{0, 0, kPi / 2} * map.drawn_T_origin;
      if (trial % 5 < 2) pose = Pose2{0.003, -0.004, 0} * pose;  // no border on a border
      const Testimony said = hear(map, pose, view), expected = slow.hear(map, pose);
      differing_counts += std::abs(said.free - expected.free) + std::abs(said.occupied - expected.occupied);
    }
    cells += side * side;
    differing += slow.differing(view);
  }
  EXPECT_LE(differing, cells / 500) << "rounding alone";
  EXPECT_LE(differing_counts, cells / 250);
  RecordProperty("differing", differing);
}

TEST(Witness, IsNotHeardWhereOthersSpoke) {
  CellBitmap all;
  all.reset({{0, 0}, {0, 0}});
  for (int r = 0; r < all.rows(); ++r) all.row(r)[0] = ~std::uint64_t{0};
  FinishedMap full;
  full.free = TiledBitmap(all);
  BlockView view({32, 32}, 32);
  EXPECT_EQ(hear(full, {}, view).free, 32 * 32);
  EXPECT_TRUE(view.is_decided());
  FinishedMap solid;
  solid.occupied = TiledBitmap(all);
  const Testimony late = hear(solid, {}, view);
  EXPECT_EQ(late.free + late.occupied, 0);
}

TEST(Witness, FarAwayHasNothingToSay) {
  std::mt19937 random(8);
  const FinishedMap map = random_map(random);
  BlockView view({0, 0}, 32);
  const Testimony said = hear(map, {5000, -5000, 1.0}, view);
  EXPECT_EQ(said.free + said.occupied, 0);
  EXPECT_FALSE(view.is_decided());
}

}  // namespace
}  // namespace dynslam
