// SPDX-License-Identifier: MIT
#include "drive/walker_watch.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "drive/clearance.h"
#include "drive/drawn_scan.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;

constexpr double kBlind_m = 0.2;
const DrawnWorld kHall{{{-6, -6, -6, 6}, {6, -6, 6, 6}, {-6, 6, 6, 6}, {-6, -6, 6, -6}}, {}};

/// Somebody who comes from the right along the robot's left side, and stands beside it.
DrawnWorld with_walker(double x, double y) {
  DrawnWorld world = kHall;
  const double swing = 0.2 * std::sin(x / 0.7 * kPi);
  world.posts = {{x + swing, y, 0.07}, {x - swing, y + 0.2, 0.07}};
  return world;
}

/// Ten scans a second of what there is then, seen by a robot that moves by so much in between.
struct Watch {
  WalkerWatch walkers{kBlind_m};
  Time now{};
  Pose2 at;
  std::mt19937 random{5};

  /// `guess`: of how it moved.
  void see(const DrawnWorld& world, const Pose2& moved = {}) { see(world, moved, moved); }
  void see(const DrawnWorld& world, const Pose2& moved, const Pose2& guess) {
    std::normal_distribution<float> noise(0.0F, 0.008F);
    now += milliseconds(100);
    at = at * moved;
    Scan scan = scan_of(world, now, 900, at);
    for (Beam& beam : scan.beams) beam.range_m += noise(random);
    scan = as_a3(std::move(scan));
    walkers.see(obstacle_points(scan, {}, 0.1, {}), {now, {}, Sight(scan, 0.0), guess});
  }
  std::vector<ObstaclePoint> rings() const {
    std::vector<ObstaclePoint> points;
    walkers.add_to(points, {});
    return points;
  }
};

TEST(WalkerWatch, LeavesRoomForAStepToWhoStands) {
  Watch watch;
  for (int i = 0; i < 20; ++i) watch.see(with_walker(1.6 - 0.08 * i, 0.5));
  const auto is_ahead_of_leg = [](const ObstaclePoint& p) { return p.y_m < 0.35F && p.y_m > 0.2F; };
  EXPECT_TRUE(std::ranges::any_of(watch.rings(), is_ahead_of_leg));
  const Time stands = watch.now;
  while (watch.now - stands < WalkerWatch::kStands - milliseconds(300)) watch.see(with_walker(0.0, 0.5));
  EXPECT_FALSE(watch.rings().empty());
  for (int i = 0; i < 10; ++i) watch.see(with_walker(0.0, 0.5));
  EXPECT_TRUE(watch.rings().empty()) << "he stays";
}

TEST(WalkerWatch, NobodyIsWhereHeLeft) {
  Watch watch;
  for (int i = 0; i < 20; ++i) watch.see(with_walker(1.6 - 0.08 * i, 0.5));
  for (int i = 0; i < 15; ++i) watch.see(with_walker(-0.08 * i, 0.5));
  for (const ObstaclePoint& p : watch.rings()) EXPECT_LT(p.x_m, -0.6F) << "the rings go with him";
  for (int i = 0; i < 20; ++i) watch.see(kHall);
  EXPECT_TRUE(watch.rings().empty());
}

TEST(WalkerWatch, RemembersWhoIsTooNearToBeSeen) {
  Watch watch;
  for (int i = 0; i < 14; ++i) watch.see(with_walker(1.3 - 0.1 * i, 0.26));
  for (int i = 0; i < 30; ++i) watch.see(with_walker(0.0, 0.26));
  EXPECT_FALSE(watch.rings().empty());
  watch.see(kHall);
  EXPECT_TRUE(watch.rings().empty()) << "one sees through where he was";
}

/// Legs of furniture, a box, a gap in a wall through which another is seen.
DrawnWorld furnished() {
  DrawnWorld world = kHall;
  world.posts = {{-1.0, 0.5, 0.02}, {-0.5, 0.5, 0.02}, {0.0, 0.6, 0.07}, {0.3, -0.4, 0.03}};
  const std::vector<DrawnWorld::Wall> walls{{-1.5, -0.5, -1.4, -0.5}, {-1.4, -0.5, -1.4, -0.6},
                                            {0.8, 0.6, 1.6, 0.6},     {1.8, 0.6, 2.6, 0.6},
                                            {0.8, 1.2, 2.6, 1.2},     {0.8, -0.8, 2.0, -0.8}};
  world.walls.insert(world.walls.end(), walls.begin(), walls.end());
  return world;
}

TEST(WalkerWatch, WhatTheRobotDrivesByDoesNotWalk) {
  const DrawnWorld world = furnished();
  for (const double speed_mps : {0.1, 0.3, 0.5}) {
    for (const double guess : {0.7, 1.0, 1.3}) {
      Watch watch;
      watch.at = {-2.5, 0.0, 0.0};
      while (watch.at.x < 2.5) {
        const double moved_m = 0.1 * speed_mps;
        watch.see(world, {moved_m, 0.0, 0.0}, {guess * moved_m, 0.0, 0.0});
        ASSERT_TRUE(watch.rings().empty()) << watch.at.x << ", " << speed_mps << ", " << guess;
      }
    }
  }
  Watch turning;
  for (int i = 0; i < 100; ++i) {
    turning.see(world, {0.0, 0.0, 0.1});
    ASSERT_TRUE(turning.rings().empty()) << i;
  }
}

TEST(WalkerWatch, GlassDoesNotWalk) {
  Watch watch;
  watch.at = {-2.0, 0.0, 0.0};
  for (int i = 0; i < 80; ++i) {
    DrawnWorld world = kHall;
    const double x = watch.at.x + 0.05;
    world.walls.push_back({x - 0.06, 0.5, x + 0.06, 0.5});  // the patch that it meets squarely
    watch.see(world, {0.05, 0.0, 0.0});
    ASSERT_TRUE(watch.rings().empty()) << i;
  }
}

TEST(WalkerWatch, ForgetsWhenNobodyKnowsHowTheRobotMoved) {
  Watch watch;
  for (int i = 0; i < 20; ++i) watch.see(with_walker(1.6 - 0.08 * i, 0.5));
  ASSERT_FALSE(watch.rings().empty());
  const Scan nothing = scan_of(kHall);
  watch.walkers.see({}, {watch.now, {}, Sight(nothing, 0.0), std::nullopt});
  EXPECT_TRUE(watch.rings().empty());
}

TEST(WalkerWatch, TheRobotDoesNotTurnIntoSomebodysNextStep) {
  const auto free_m = [](bool came) {
    Clearance clearance;
    RecentMotion motion;
    Time now{};
    motion.add(now, {}, {});
    for (int i = 0; i < 40; ++i) {
      now += milliseconds(100);
      const double x = came ? std::max(0.0, 1.6 - 0.08 * i) : 0.0;
      clearance.see(as_a3(scan_of(with_walker(x, 0.34), now, 900)), motion);
    }
    return clearance.free_m(now, {0.0, 0.5}, motion, 0.01);
  };
  EXPECT_TRUE(std::isinf(free_m(false))) << "beside a post there is room enough";
  EXPECT_LT(free_m(true), 0.1);
}

}  // namespace
}  // namespace dynslam
