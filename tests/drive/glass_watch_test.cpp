// SPDX-License-Identifier: MIT
#include "drive/glass_watch.h"

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

const std::vector<DrawnWorld::Wall> kHall{{-6, -6, -6, 6}, {6, -6, 6, 6}, {-6, 6, 6, 6}, {-6, -6, 6, -6}};
const DrawnWorld kPane{{{-5, 1, 5, 1}}, {}};

/// Beams meet glass along x only when they are as square to it as this; noisy.
Scan scan_through(const DrawnWorld& solid, const DrawnWorld& glass, Time stamp, const Pose2& world_T_robot,
                  std::mt19937& random) {
  std::normal_distribution<float> noise(0.0F, 0.011F);
  std::uniform_real_distribution<double> least_cosine(0.97, 1.0);
  Scan scan = scan_of(solid, stamp, 1200, world_T_robot);
  for (Beam& beam : scan.beams) {
    const double cosine = std::abs(std::sin(world_T_robot.yaw + beam.angle_rad));
    if (cosine > least_cosine(random))
      beam.range_m = std::min(beam.range_m, static_cast<float>(cast(glass, world_T_robot, beam.angle_rad)));
    beam.range_m += noise(random);
  }
  return as_a3(std::move(scan));
}

/// A robot that drives straight, 2 cm for each of ten scans a second.
struct Walk {
  explicit Walk(const Pose2& from) : at(from) {}
  Pose2 at;
  DrawnWorld solid{kHall, {}}, glass = kPane;
  Time now{};
  std::mt19937 random{4};
  Clearance clearance;
  RecentMotion motion;

  void step() {
    motion.add(now, {0.2, 0.0}, {});
    now += milliseconds(100);
    at = at * Pose2{0.02, 0.0, 0.0};
    clearance.see(scan_through(solid, glass, now, at, random), motion);
  }
  void steps(int n) {
    for (int i = 0; i < n; ++i) step();
  }
};

TEST(GlassWatch, KnowsAPaneByItsWanderingPatch) {
  Walk walk({-2, 0.5, 0.0});
  walk.steps(5);
  EXPECT_TRUE(walk.clearance.panes().empty()) << "it may be a post";
  walk.steps(25);
  const auto panes = walk.clearance.panes();
  ASSERT_EQ(panes.size(), 1U);
  EXPECT_NEAR(panes[0].length_m(), 0.65, 0.12);
  for (const Vector2& end : {panes[0].from, panes[0].to}) EXPECT_NEAR(end.y(), 0.5, 0.03);
}

TEST(GlassWatch, KeepsTheRobotFromDrivingIntoItAslant) {
  for (const double yaw : {0.35, 0.8, 1.1}) {
    Walk walk({-2, -0.4, yaw});
    const auto corner_y = [&] {
      double most = -9.0;
      for (const double side : {-0.12, 0.12}) most = std::max(most, (walk.at * Vector2(0.14, side)).y());
      return most;
    };
    while (corner_y() < 1.0 - 0.06) walk.step();
    const Twist ahead{0.2, 0.0};
    EXPECT_LE(walk.clearance.way(walk.now, ahead, walk.motion).share, 0.5) << yaw;
    EXPECT_EQ(walk.clearance.way(walk.now, {-0.2, 0.0}, walk.motion).share, 1.0) << yaw;
    while (corner_y() < 1.0 - 0.015) walk.step();
    EXPECT_EQ(walk.clearance.way(walk.now, ahead, walk.motion).share, 0.0) << yaw;
  }
}

TEST(GlassWatch, TakesNoOtherThingForAPane) {
  DrawnWorld things{kHall, {{-1.2, 0.9, 0.03}, {-0.4, 0.95, 0.1}}};
  things.walls.push_back({-1.8, 0.9, -1.7, 0.9});   // a leg
  things.walls.push_back({-1.8, 0.0, -1.55, 0.0});  // a box
  things.walls.push_back({-1.0, -0.5, 2.0, -0.5});  // a wall
  for (const double y : {0.4, 0.2, 0.6}) {
    Walk walk({-2, y, 0.0});
    walk.solid = things;
    walk.glass = {};
    for (int i = 0; i < 100; ++i) {
      walk.step();
      EXPECT_TRUE(walk.clearance.panes().empty()) << y << ", step " << i;
    }
  }
}

/// Who walked by so near would else stand in the robot's way for half a minute.
TEST(GlassWatch, ForgetsWhatItSeesNoMoreUnlessItIsTooNearToBeSeenAndWasGlassForSomeTime) {
  struct Case {
    double away_m;
    int scans;
    double kept_s;
  };
  for (const auto& [away_m, scans, kept_s] :
       {Case{0.5, 30, 1.5}, {0.22, 30, 30.0}, {0.22, 14, 8.0}, {0.22, 10, 1.5}}) {
    Walk walk({-2, 1.0 - away_m, 0.0});
    GlassWatch watch(0.2);
    Time now{};
    const auto added = [&] {
      std::vector<ObstaclePoint> points;
      watch.add_to(points, {});
      return points.size();
    };
    for (int i = 0; i < scans; ++i) {
      now += milliseconds(100);
      const Scan seen =
          scan_through(walk.solid, walk.glass, now, {-2 + 0.02 * i, 1.0 - away_m, 0.0}, walk.random);
      watch.see(obstacle_points(seen, {}, 0.1, {}), {now, {}, Sight(seen, 0.0), Pose2{0.02, 0.0, 0.0}});
    }
    EXPECT_GT(added(), 10U);
    const Scan nothing = scan_of(DrawnWorld{kHall, {}});
    for (int i = 1; i < 100; ++i) {
      now += milliseconds(100);
      watch.see({}, {now, {}, Sight(nothing, 0.0), Pose2{}});
      if (std::abs(0.1 * i - kept_s) < 0.25) continue;  // it was seen last a scan or two before
      EXPECT_EQ(added() > 0, 0.1 * i < kept_s) << away_m << " m, " << scans << ", " << i;
    }
    watch.see({}, {now, {}, Sight(nothing, 0.0), std::nullopt});
    EXPECT_EQ(added(), 0U) << "nobody knows where it is";
  }
}

/// Who comes to it aslant from near sees but little of it before he sees nothing.
TEST(GlassWatch, TellsAtLastOfAPaneThatComesTooNearToBeSeen) {
  Walk walk({-2, 0.728, 0.3});
  walk.solid = {kHall, {}};
  bool told = false;
  while (walk.at.y < 0.795) {
    walk.step();
    EXPECT_TRUE(walk.clearance.panes().empty()) << walk.at.y;
  }
  for (int i = 0; i < 6; ++i) {
    walk.step();
    for (const Segment& pane : walk.clearance.panes()) {
      told = true;
      EXPECT_GT(pane.length_m(), 2.0) << "and takes it to go on";
      const Segment in_map{walk.at * pane.from, walk.at * pane.to};
      EXPECT_NEAR(0.5 * (in_map.from.y() + in_map.to.y()), 1.0, 0.03);
    }
  }
  EXPECT_TRUE(told);
}

TEST(GlassWatch, GoesOnALittleBesideThePatchOnly) {
  Walk walk({-2, 0.6, 0.0});
  GlassWatch watch(0.2);
  for (int i = 0; i < 30; ++i) {
    const Pose2 at{-2 + 0.02 * i, 0.6, 0.0};
    const Scan seen = scan_through(walk.solid, walk.glass, Time(milliseconds(100 * i)), at, walk.random);
    watch.see(obstacle_points(seen, {}, 0.1, {}), {seen.stamp, {}, Sight(seen, 0.0), Pose2{0.02, 0.0, 0.0}});
  }
  std::vector<ObstaclePoint> points;
  watch.add_to(points, {});
  ASSERT_GT(points.size(), 20U);
  for (const ObstaclePoint& p : points) {
    EXPECT_NEAR(p.y_m, 0.4, 0.05);
    EXPECT_LT(std::abs(p.x_m), 0.4);
  }
}

}  // namespace
}  // namespace dynslam
