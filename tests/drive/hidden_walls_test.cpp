// SPDX-License-Identifier: MIT
#include "drive/hidden_walls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "drive/clearance.h"
#include "drive/drawn_scan.h"

namespace dynslam {
namespace {

constexpr double kBlind_m = 0.2;
const std::vector<DrawnWorld::Wall> kRoom{{-3, -3, -3, 3}, {3, -3, 3, 3}, {-3, 3, 3, 3}, {-3, -3, 3, -3}};

/// Something large beside the robot's right rear corner, which is 0.19 m off; the robot faces away from it,
/// aslant.
const Vector2 kCorner(-0.16, -0.10), kAlong(0.643, -0.766), kBehind(-0.766, -0.643);

DrawnWorld fridge() {
  const Vector2 end = kCorner + 0.6 * kAlong, back = kCorner + 0.6 * kBehind;
  DrawnWorld world{kRoom, {}};
  world.walls.push_back({kCorner.x(), kCorner.y(), end.x(), end.y()});
  world.walls.push_back({kCorner.x(), kCorner.y(), back.x(), back.y()});
  return world;
}

/// What is added to what is seen.
std::vector<Vector2> hidden_in(const Scan& scan) {
  std::vector<ObstaclePoint> points = obstacle_points(scan, {}, 0.1, {});
  const std::size_t seen = points.size();
  continue_walls(points, {end_of(scan), {}, Sight(scan, 0.0), {}}, {}, kBlind_m);
  std::vector<Vector2> hidden;
  for (std::size_t i = seen; i < points.size(); ++i) hidden.emplace_back(points[i].x_m, points[i].y_m);
  return hidden;
}

double off_face_m(const Vector2& p) { return std::abs((p - kCorner).dot(Vector2(-kAlong.y(), kAlong.x()))); }

TEST(HiddenWalls, GoOnToTheirEnd) {
  const auto hidden = hidden_in(as_a3(scan_of(fridge())));
  double least_m = 1.0;
  for (const Vector2& p : hidden) {
    EXPECT_LT(off_face_m(p), 0.001);
    least_m = std::min(least_m, (p - kCorner).dot(kAlong));
  }
  EXPECT_NEAR(least_m, 0.0, 0.015) << "a sector's width";
}

TEST(HiddenWalls, AreFoundInNoise) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0.0F, 0.011F);
  double sum_m = 0.0;
  for (int i = 0; i < 50; ++i) {
    Scan scan = scan_of(fridge());
    for (Beam& beam : scan.beams) beam.range_m += noise(random);
    const auto hidden = hidden_in(as_a3(scan));
    ASSERT_GE(hidden.size(), 5U);
    for (const Vector2& p : hidden) {
      EXPECT_LT(off_face_m(p), 0.025);
      sum_m += off_face_m(p) / static_cast<double>(hidden.size());
    }
  }
  EXPECT_LT(sum_m / 50, 0.006);
}

TEST(HiddenWalls, NothingIsAddedToWhatIsSeenWhole) {
  EXPECT_TRUE(hidden_in(as_a3(scan_of({kRoom, {}}))).empty());
  EXPECT_TRUE(hidden_in(as_a3(scan_of(wall_at(0.3)))).empty());
  EXPECT_TRUE(hidden_in(as_a3(scan_of({kRoom, {{0.3, 0.0, 0.02}}}))).empty()) << "a leg";
  EXPECT_TRUE(hidden_in({}).empty());
}

/// Glass, or black: no reason to think that a wall is there.
TEST(HiddenWalls, NothingIsTakenForAWallWhereItWouldBeSeen) {
  Scan scan = scan_of(fridge());
  for (Beam& beam : scan.beams)
    if (beam.range_m < 0.3F) beam.range_m = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(hidden_in(scan).empty());
}

TEST(HiddenWalls, KeepTheRobotFromBackingIntoThem) {
  const Scan scan = as_a3(scan_of(fridge()));
  Clearance clearance;
  clearance.see(scan, {});
  EXPECT_LT(clearance.way(end_of(scan), {-0.05, 0.0}, {}).share, 1.0);
  EXPECT_LT(clearance.free_m(end_of(scan), {-0.05, 0.0}, {}, 0.01), 0.02);
  EXPECT_EQ(clearance.way(end_of(scan), {0.05, 0.0}, {}).share, 1.0);
}

TEST(Sight, IsOfTheScansEndAndHeedsNoLoneReturn) {
  Scan scan = scan_of({}, {}, 1200);
  for (std::size_t i = 0; i < scan.beams.size(); ++i)
    scan.beams[i].time_s = 0.1F * static_cast<float>(i) / 1199.0F;
  scan.beams[100].range_m = 2.0F;
  for (std::size_t i = 600; i < 610; ++i) scan.beams[i].range_m = 1.0F;
  const auto seen = [](const Sight& sight) {
    std::vector<std::size_t> sectors;
    for (std::size_t i = 0; i < Sight::kSectors; ++i)
      if (sight.farthest_m(i) > 0.0) sectors.push_back(i);
    return sectors;
  };
  EXPECT_EQ(seen(Sight(scan, 0.0)), std::vector<std::size_t>{60});
  const double half_sector = kTwoPi / 240;
  // Half of its turn was still to come when it saw them.
  EXPECT_EQ(seen(Sight(scan, 8 * half_sector)), (std::vector<std::size_t>{58}));
  EXPECT_NEAR(Sight(scan, 0.0).farthest_m(60), 1.0, 1e-6);
}

}  // namespace
}  // namespace dynslam
