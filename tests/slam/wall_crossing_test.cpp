// SPDX-License-Identifier: MIT
#include "slam/wall_crossing.h"

#include <gtest/gtest.h>

#include "slam/drawn_finished_map.h"

namespace dynslam {
namespace {

constexpr double kCell = 0.02;
const Pose2 kRobot{2.0, 2.5, 0.4};
const Vector2 kLidar{0.1, -0.05};

/// What a robot sees of a world, as points in its own frame, in cells.
std::vector<MatchPoint> seen(const DrawnWorld& world, const Pose2& world_T_robot) {
  std::mt19937 random(8);
  LidarMount mount;
  mount.robot_T_lidar = {kLidar.x(), kLidar.y(), 0};
  const Scan scan = look(
      world, {}, [&](Time) { return world_T_robot; }, {.turn_s = 0, .noise_m = 0.01}, random, mount);
  std::vector<MatchPoint> points;
  for (const Beam& b : scan.beams) {
    const Vector2 p = (kLidar + b.range_m * Vector2(std::cos(b.angle_rad), std::sin(b.angle_rad))) / kCell;
    points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y())});
  }
  return points;
}

/// The map of a world that the robot stands in.
class WallCrossing : public testing::Test {
 protected:
  double share(const DrawnWorld& sees, const Pose2& stands, const Pose2& believes) const {
    return share_through_walls(map_, seen(sees, stands), believes, kLidar);
  }

  DrawnWorld world_ = two_rooms();
  ChunkedGrid map_ = draw_grid(world_, {.world_T_robot = {kRobot, {2.4, 2.2, 0}, {1.6, 2.9, 1}}});
};

TEST_F(WallCrossing, WhereTheRobotIsThereIsNone) {
  EXPECT_LT(share(world_, kRobot, kRobot), 0.01);
  EXPECT_LT(share(world_, kRobot, kRobot * Pose2{0.03, -0.02, 0.01}), 0.03);
}

TEST_F(WallCrossing, InAnotherPlaceThereIsMuch) {
  EXPECT_GT(share(world_, {3.0, 2.5, 0.4}, kRobot), 0.15);
  EXPECT_GT(share(world_, {2.0, 1.5, 0.4}, kRobot), 0.15);
  EXPECT_GT(share(world_, kRobot, kRobot * Pose2{0, 0, 0.8}), 0.15);
}

TEST_F(WallCrossing, PeopleAndMovedFurnitureAreNone) {
  DrawnWorld crowded = world_;
  for (int i = 0; i < 6; ++i) {
    const Vector2 p = kRobot * (Vector2(std::cos(1.0 * i), std::sin(1.0 * i)) * (0.8 + 0.1 * i));
    crowded.add_box(p.x() - 0.2, p.y() - 0.15, p.x() + 0.2, p.y() + 0.15);
  }
  EXPECT_LT(share(crowded, kRobot, kRobot), 0.01);
}

TEST_F(WallCrossing, AnOpenedDoorIsLittle) {
  DrawnWorld open = world_;
  open.walls[0].to.x() = 1.5;  // the lower wall, and a garden behind it
  open.walls.push_back({{2.4, 0.011}, {8.013, 0.011}});
  open.walls.push_back({{0, -3}, {8, -3}});
  const double through = share(open, kRobot, kRobot);
  EXPECT_GT(through, 0.02);
  EXPECT_LT(through, 0.1);
}

TEST_F(WallCrossing, WhatIsSeenThroughADoorForTheFirstTimeIsNone) {
  const Pose2 at_the_door{4.3, 2.45, 0};
  EXPECT_LT(share(world_, at_the_door, at_the_door), 0.03);
}

TEST_F(WallCrossing, NoPointsCrossNothing) { EXPECT_EQ(share_through_walls(map_, {}, kRobot, kLidar), 0.0); }

}  // namespace
}  // namespace dynslam
