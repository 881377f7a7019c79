// SPDX-License-Identifier: MIT
#include "grid/bitmap_sets.h"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

constexpr ChunkBox kBox{{-1, -1}, {1, 0}};

CellBitmap random_cells(std::mt19937& random, unsigned percent) {
  CellBitmap cells;
  cells.reset(kBox);
  for (int y = -64; y < 64; ++y) {
    for (int x = -64; x < 128; ++x) {
      if (random() % 100 < percent) cells.set({x, y});
    }
  }
  return cells;
}

bool is_inside(CellIndex c) { return c.x >= -64 && c.x < 128 && c.y >= -64 && c.y < 64; }

/// Whether all, or any, of the cells up to `reach` away in x and y are set, those beyond the box left out.
bool all_around(const CellBitmap& cells, CellIndex at, int reach) {
  for (int y = at.y - reach; y <= at.y + reach; ++y) {
    for (int x = at.x - reach; x <= at.x + reach; ++x) {
      if (is_inside({x, y}) && !cells.test({x, y})) return false;
    }
  }
  return true;
}
bool any_around(const CellBitmap& cells, CellIndex at, int reach) {
  for (int y = at.y - reach; y <= at.y + reach; ++y) {
    for (int x = at.x - reach; x <= at.x + reach; ++x) {
      if (cells.test({x, y})) return true;
    }
  }
  return false;
}

template <class IsIn>
void expect_cells(const CellBitmap& got, IsIn&& is_in) {
  for (int y = -64; y < 64; ++y) {
    for (int x = -64; x < 128; ++x) ASSERT_EQ(got.test({x, y}), is_in(CellIndex{x, y})) << x << " " << y;
  }
}

TEST(BitmapSets, ShrinkToCellsWithAllAroundThemSet) {
  std::mt19937 random(1);
  for (int times = 0; times <= 4; ++times) {
    const CellBitmap cells = random_cells(random, times < 2 ? 90 : 99);
    const CellBitmap shrunk = shrunk_all_round(cells, times);
    expect_cells(shrunk, [&](CellIndex c) { return all_around(cells, c, times); });
  }
}

TEST(BitmapSets, GrowToCellsWithAnyAroundThemSet) {
  std::mt19937 random(2);
  for (int times = 0; times <= 4; ++times) {
    const CellBitmap cells = random_cells(random, times < 2 ? 10 : 1);
    const CellBitmap grown = grown_all_round(cells, times);
    expect_cells(grown, [&](CellIndex c) { return any_around(cells, c, times); });
  }
}

TEST(BitmapSets, GrowBySidesAlone) {
  std::mt19937 random(3);
  const CellBitmap cells = random_cells(random, 20);
  expect_cells(grown_by_sides(cells), [&](CellIndex c) {
    return cells.test(c) || cells.test({c.x + 1, c.y}) || cells.test({c.x - 1, c.y}) ||
           cells.test({c.x, c.y + 1}) || cells.test({c.x, c.y - 1});
  });
}

TEST(BitmapSets, AreAddedKeptAndTakenOut) {
  std::mt19937 random(4);
  const CellBitmap a = random_cells(random, 50), b = random_cells(random, 50);
  CellBitmap either = a, both = a, less = a;
  add_all(either, b);
  keep_only(both, b);
  take_out(less, b);
  expect_cells(either, [&](CellIndex c) { return a.test(c) || b.test(c); });
  expect_cells(both, [&](CellIndex c) { return a.test(c) && b.test(c); });
  expect_cells(less, [&](CellIndex c) { return a.test(c) && !b.test(c); });
}

TEST(BitmapSets, ComplementIsWhatIsNotIn) {
  std::mt19937 random(6);
  const CellBitmap cells = random_cells(random, 50);
  const CellBitmap others = complement(cells);
  expect_cells(others, [&](CellIndex c) { return !cells.test(c); });
}

/// Whether any cell of a rectangle around a cell is set.
bool any_in(const CellBitmap& cells, CellIndex at, CellIndex low, CellIndex high) {
  for (int y = at.y + low.y; y <= at.y + high.y; ++y) {
    for (int x = at.x + low.x; x <= at.x + high.x; ++x) {
      if (cells.test({x, y})) return true;
    }
  }
  return false;
}

TEST(BitmapSets, GrowAcrossTheLinesThatTheyForm) {
  std::mt19937 random(7);
  const CellBitmap cells = random_cells(random, 6);
  const auto grows = [&](CellIndex c, bool up_down) {
    const bool left = any_in(cells, c, {-2, -2}, {-2, 2}), right = any_in(cells, c, {2, -2}, {2, 2}),
               below = any_in(cells, c, {-2, -2}, {2, -2}), above = any_in(cells, c, {-2, 2}, {2, 2});
    const bool is_post = !left && !right && !below && !above;
    return cells.test(c) && (is_post || (up_down ? left && right : below && above));
  };
  const CellBitmap grown = grown_across(cells);
  expect_cells(grown, [&](CellIndex c) {
    bool is_in = cells.test(c);
    for (int n = -2; n <= 2; ++n)
      is_in = is_in || grows({c.x, c.y + n}, true) || grows({c.x + n, c.y}, false);
    return is_in;
  });
}

/// Rows of a drawing from the top; '+' is a gap to be found.
void expect_gaps(const std::vector<std::string>& rows) {
  for (const bool turned : {false, true}) {
    CellBitmap lines, gaps;
    lines.reset(kBox);
    gaps.reset(kBox);
    for (int r = 0; r < static_cast<int>(rows.size()); ++r) {
      const std::string& row = rows[static_cast<std::size_t>(r)];
      for (int i = 0; i < static_cast<int>(row.size()); ++i) {
        const CellIndex at = turned ? CellIndex{-r, 60 - i - 4} : CellIndex{58 + i, -r};
        if (row[static_cast<std::size_t>(i)] == '#') lines.set(at);
        if (row[static_cast<std::size_t>(i)] == '+') gaps.set(at);
      }
    }
    const CellBitmap found = gaps_in_lines(lines);
    expect_cells(found, [&](CellIndex c) { return gaps.test(c); });
  }
}

TEST(BitmapSets, GapsInLinesAreOneOrTwoCellsStraightOnOrACellAside) {
  expect_gaps({"####+####"});
  expect_gaps({"###++###"});
  expect_gaps({"###   ###"});
  expect_gaps({"###+   ", "   +###"});
  expect_gaps({"##    ##", "##    ##"});
  expect_gaps({"#      ", " #     ", "  #    ", "   ##  ", "     ##"});
  expect_gaps({"########", "        ", "########"});
}

}  // namespace
}  // namespace dynslam
