// SPDX-License-Identifier: MIT
#include "grid/free_space.h"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "grid/ray_walk.h"

namespace dynslam {
namespace {

constexpr double kCell = 0.05;

RayEnd ray(double bearing, double range, bool hit = true) {
  return {static_cast<float>(range * std::cos(bearing)), static_cast<float>(range * std::sin(bearing)),
          static_cast<float>(bearing), static_cast<float>(range), hit};
}

/// A full turn of n rays, each as long as `range(bearing)` says.
template <class Range>
std::vector<RayEnd> full_turn(int n, Range&& range) {
  std::vector<RayEnd> ends;
  for (int i = 0; i < n; ++i) {
    const double bearing = -kPi + (i + 0.5) * kTwoPi / n;
    ends.push_back(ray(bearing, range(bearing)));
  }
  return ends;
}

double square_room(double bearing) {
  return 2.02 / std::max(std::abs(std::cos(bearing)), std::abs(std::sin(bearing)));
}

std::set<CellIndex> cells_of(const CellBitmap& bits) {
  std::set<CellIndex> cells;
  for (int y = 0; y < bits.rows(); ++y) {
    for (int x = 0; x < bits.words_per_row() * kChunkSide; ++x) {
      const CellIndex c{bits.first().x + x, bits.first().y + y};
      if (bits.test(c)) cells.insert(c);
    }
  }
  return cells;
}

TEST(FreeSpace, OfARoomIsTheRoomLessARingAtItsWalls) {
  FreeSpace free_space;
  const auto ends = full_turn(720, square_room);
  const ScanFootprint& f = free_space.trace({}, ends, radians(2), kCell);
  // Walls at 2.02 m are the 41st cells; a ring of one cell beside them is left alone.
  for (int y = -45; y <= 45; ++y) {
    for (int x = -45; x <= 45; ++x) {
      const bool inside = x >= -39 && x <= 38 && y >= -39 && y <= 38;
      const bool outside = x < -41 || x > 40 || y < -41 || y > 40;
      EXPECT_TRUE(!inside || f.misses.test({x, y})) << x << " " << y;
      EXPECT_FALSE(outside && f.misses.test({x, y})) << x << " " << y;
    }
  }
  EXPECT_GT(f.hits.size(), 300U);
}

TEST(FreeSpace, TouchesNoCellTwiceAndNoHitOrItsRing) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(0.2, 4.0);
  FreeSpace free_space;
  for (int trial = 0; trial < 40; ++trial) {
    const auto ends = full_turn(300, [&](double) { return any(random); });
    const ScanFootprint& f =
        free_space.trace({any(random), -any(random), any(random)}, ends, radians(3), kCell);
    std::set<CellIndex> hits(f.hits.begin(), f.hits.end());
    EXPECT_EQ(hits.size(), f.hits.size());
    for (const CellIndex h : hits) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) EXPECT_FALSE(f.misses.test({h.x + dx, h.y + dy}));
      }
    }
  }
}

/// The same rules, cell by cell: a cell is passed when its centre lies nearer than the chord of its wedge,
/// or, where the surface breaks off, nearer than the near end's.
std::set<CellIndex> brute_force(const Pose2& pose, const std::vector<RayEnd>& ends, double max_wedge) {
  std::set<CellIndex> passed;
  const int reach = static_cast<int>(5 / kCell);
  const CellIndex middle = cell_at(pose.translation(), kCell);
  const Pose2 inverse = pose.inverse();
  for (int y = middle.y - reach; y <= middle.y + reach; ++y) {
    for (int x = middle.x - reach; x <= middle.x + reach; ++x) {
      const Vector2 p = inverse * cell_centre({x, y}, kCell);
      const double bearing = std::atan2(p.y(), p.x());
      for (std::size_t i = 0; i < ends.size(); ++i) {
        const RayEnd& a = ends[i];
        const RayEnd& b = ends[(i + 1) % ends.size()];
        const double wedge = wrap_angle(b.bearing_rad - a.bearing_rad),
                     in = wrap_angle(bearing - a.bearing_rad);
        if (wedge <= 0 || wedge > max_wedge || in < 0 || in >= wedge) continue;
        Vector2 pa(a.x_m, a.y_m), pb(b.x_m, b.y_m);
        const double step = std::abs(a.range_m - b.range_m), arc = std::min(a.range_m, b.range_m) * wedge;
        if (step > 0.1 + 3 * arc) {
          const double near = std::min(a.range_m, b.range_m);
          pa *= near / a.range_m;
          pb *= near / b.range_m;
        }
        const Vector2 chord = pb - pa;
        if (chord.x() * (p - pa).y() - chord.y() * (p - pa).x() > 0) passed.insert({x, y});
      }
    }
  }
  return passed;
}

TEST(FreeSpace, AgreesWithBruteForceInJaggedSurroundings) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> range(0.4, 4.0), place(-3, 3), angle(-3, 3);
  FreeSpace free_space;
  for (int trial = 0; trial < 12; ++trial) {
    double level = 2;
    auto ends = full_turn(240, [&](double) {
      if (random() % 12 == 0) level = range(random);  // a step between surfaces now and then
      return level + 0.02 * static_cast<double>(random() % 3);
    });
    // A gap of two fifths of the turn: a lidar that looks ahead only.
    if (trial % 2) ends.erase(ends.begin() + 20, ends.begin() + 120);
    for (RayEnd& e : ends) e.hit = false;
    const Pose2 pose{place(random), place(random), angle(random)};
    const double max_wedge = radians(4);
    const auto expected = brute_force(pose, ends, max_wedge);
    const auto got = cells_of(free_space.trace(pose, ends, max_wedge, kCell).misses);
    int wrong = 0;
    for (const CellIndex c : expected) wrong += got.contains(c) ? 0 : 1;
    EXPECT_LE(wrong, 6) << "missing, of " << expected.size();  // centres that lie on an edge up to rounding
    // What is more than the polygon are the cells of rays that stand alone.
    std::set<CellIndex> on_rays;
    for (const RayEnd& e : ends) {
      walk_ray(pose.translation(), pose * Vector2(e.x_m, e.y_m), kCell, [&](CellIndex c) {
        for (int d = -1; d <= 1; ++d) on_rays.insert({c.x + d, c.y}), on_rays.insert({c.x, c.y + d});
      });
    }
    for (const CellIndex c : got) {
      EXPECT_TRUE(expected.contains(c) || on_rays.contains(c)) << c.x << " " << c.y;
    }
  }
}

TEST(FreeSpace, CoversWhatWalkingEachRayCoversButTheGrazedRim) {
  FreeSpace free_space;
  const auto ends = full_turn(720, square_room);
  const Pose2 pose{0.313, -0.127, 0.4};
  const auto cells = cells_of(free_space.trace(pose, ends, radians(2), kCell).misses);
  std::set<CellIndex> walked;
  for (const RayEnd& e : ends) {
    const Vector2 end = pose * Vector2(e.x_m, e.y_m);
    const Vector2 short_of_it = pose.translation() + 0.92 * (end - pose.translation());
    walk_ray(pose.translation(), short_of_it, kCell, [&](CellIndex c) { walked.insert(c); });
  }
  for (const CellIndex c : walked) EXPECT_TRUE(cells.contains(c)) << c.x << " " << c.y;
}

TEST(FreeSpace, SeesTheSameAcrossTheSeamOfTheCircle) {
  // A room with a near thing whose edge lies where bearings jump from pi to -pi, and the same scene turned
  // away from there.
  const auto scene = [](double turned) {
    auto ends = full_turn(720, square_room);
    for (RayEnd& e : ends) {
      const double seen = wrap_angle(e.bearing_rad - turned);
      e = ray(e.bearing_rad, seen > 0.0 && seen < 0.5 ? 0.8 : 2.0);
    }
    return ends;
  };
  FreeSpace free_space;
  const auto at_seam = scene(kPi), elsewhere = scene(0.0);
  const ScanFootprint f = free_space.trace({}, at_seam, radians(2), kCell);
  const ScanFootprint g = free_space.trace({0, 0, kPi}, elsewhere, radians(2), kCell);
  EXPECT_NEAR(static_cast<double>(f.misses.count()), static_cast<double>(g.misses.count()), 12);
  EXPECT_NEAR(static_cast<double>(f.hits.size()), static_cast<double>(g.hits.size()), 6);
}

TEST(FreeSpace, LeavesTheShadowBehindANearThingAlone) {
  FreeSpace free_space;
  auto ends = full_turn(720, square_room);
  for (RayEnd& e : ends) {
    if (std::abs(e.bearing_rad) < 0.2) e = ray(e.bearing_rad, 1.0);
  }
  const ScanFootprint& f = free_space.trace({}, ends, radians(2), kCell);
  EXPECT_TRUE(f.misses.test({15, 0}));
  EXPECT_FALSE(f.misses.test({22, 0}));
  EXPECT_FALSE(f.misses.test({35, 0}));
  EXPECT_TRUE(f.misses.test({0, 35}));
}

TEST(FreeSpace, KeepsWhatALoneRaySawThroughAGap) {
  FreeSpace free_space;
  auto ends = full_turn(90, [](double) { return 1.0; });
  ends[45] = ray(ends[45].bearing_rad, 3.0);
  const ScanFootprint& f = free_space.trace({}, ends, radians(10), kCell);
  int beyond = 0;
  for (const CellIndex c : cells_of(f.misses)) beyond += c.x > 25 ? 1 : 0;
  EXPECT_GE(beyond, 25) << "the way from 1.25 m to 2.9 m";
}

TEST(FreeSpace, OfNoRaysOrOneRayIsWell) {
  FreeSpace free_space;
  EXPECT_EQ(free_space.trace({5, 5, 1}, {}, 0.1, kCell).misses.count(), 0U);
  const std::vector<RayEnd> one = {ray(0.0, 1.0)};
  const ScanFootprint& f = free_space.trace({}, one, 0.1, kCell);
  EXPECT_EQ(f.hits.size(), 1U);
  EXPECT_EQ(f.misses.count(), 19U) << "twenty cells less the ring of the hit";
}

}  // namespace
}  // namespace dynslam
