// SPDX-License-Identifier: MIT
#include "slam/passes.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "slam/drawn_world.h"
#include "support_matchers.h"

namespace dynslam {
namespace {

Pose2 standing(Time) { return {}; }

TEST(ClampPass, KeepsWhatIsBelieved) {
  SlamConfig config;
  config.trusted_range_m = 5;
  config.min_range_m = 0.2;
  Scan scan;
  for (const float range : {0.1F, 0.3F, 4.9F, 7.0F, INFINITY, NAN}) scan.beams.push_back({0.5F, range, 0});
  const std::vector<Ray> rays = clamp_pass(scan, config);
  ASSERT_EQ(rays.size(), 3U);
  EXPECT_TRUE(rays[0].hit);
  EXPECT_TRUE(rays[1].hit);
  EXPECT_FALSE(rays[2].hit) << "beyond the trusted range the end is not believed";
  EXPECT_FLOAT_EQ(rays[2].range_m, 5.0F) << "but the way there is free";
}

TEST(ClampPass, TurnsALidarThatHangsHeadDown) {
  Scan scan;
  scan.mount.upside_down = true;
  scan.beams.push_back({0.5F, 1.0F, 0});
  EXPECT_FLOAT_EQ(clamp_pass(scan, {})[0].angle_rad, -0.5F);
}

TEST(ReferenceTime, IsTheMiddleOfTheScan) {
  Scan scan;
  scan.stamp = time_at_s(10);
  EXPECT_EQ(reference_time(scan), time_at_s(10));
  scan.beams = {{0, 1, 0}, {1, 1, 0.08F}};
  EXPECT_NEAR(seconds_of(reference_time(scan)), 10.04, 1e-6);
}

/// Ends of a scan corrected with the true motion, moved into the world: how far the worst lies off the walls.
double worst_off_walls(const DrawnWorld& world, const std::function<Pose2(Time)>& world_T_robot,
                       const LidarMount& mount) {
  std::mt19937 random(1);
  const Scan scan = look(world, time_at_s(100), world_T_robot, {.beams = 600}, random, mount);
  const Time reference = reference_time(scan);
  const Pose2 robot_T_world = world_T_robot(reference).inverse();
  const auto motion = [&](Time t) { return robot_T_world * world_T_robot(t); };
  const CorrectedScan corrected = egomotion_pass(scan, clamp_pass(scan, {}), motion);
  const Pose2 world_T_lidar = world_T_robot(reference) * corrected.robot_T_lidar;
  double worst = 0;
  float before = -4;
  for (const RayEnd& e : corrected.ends_lidar) {
    EXPECT_GE(e.bearing_rad, before);
    before = e.bearing_rad;
    EXPECT_NEAR(std::hypot(e.x_m, e.y_m), e.range_m, 1e-4);
    EXPECT_NEAR(std::abs(turn(std::atan2(e.y_m, e.x_m), e.bearing_rad)), 0.0, 0.01);
    const Vector2 p = world_T_lidar * Vector2(e.x_m, e.y_m);
    double nearest = 1e9;
    for (const auto& w : world.walls) {
      const Vector2 along = w.to - w.from;
      const double share = std::clamp(along.dot(p - w.from) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (w.from + share * along - p).norm());
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(EgomotionPass, PutsAScanTakenInMotionRight) {
  const DrawnWorld world = two_rooms();
  const auto moving = [](Time t) {
    const double s = seconds_of(t) - 100;
    return Pose2{2.0 + 0.7 * s, 2.2 - 0.2 * s, 0.4 + 2.4 * s};
  };
  EXPECT_LT(worst_off_walls(world, moving, {}), 0.002);
  EXPECT_LT(worst_off_walls(world, moving, {{0.1, -0.05, 1.0}, false}), 0.002);
  EXPECT_LT(worst_off_walls(world, moving, {{0.1, 0.05, -2.0}, true}), 0.002);
}

TEST(LevelPass, LaysTiltedRaysDownAndCutsThoseThatMeetTheFloor) {
  // Nose down by 3 degrees: ahead, the plane of the lidar meets the band's lower rim at 0.13 / sin(3 deg)
  // = 2.48 m.
  const Eigen::Quaterniond nose_down(Eigen::AngleAxisd(radians(3), Eigen::Vector3d::UnitY()));
  Scan scan;
  scan.mount.height_m = 0.18;
  std::vector<Ray> rays = {{0, 2.0F, 0, true}, {0, 4.0F, 0, true}, {static_cast<float>(kPi), 4.0F, 0, true}};
  level_pass(
      scan, [&](Time) { return nose_down; }, {.low_m = 0.05, .high_m = 0.6}, rays);
  EXPECT_TRUE(rays[0].hit);
  EXPECT_NEAR(rays[0].range_m, 2.0 * std::cos(radians(3)), 1e-4);
  EXPECT_FALSE(rays[1].hit);
  EXPECT_NEAR(rays[1].range_m, 0.13 / std::tan(radians(3)), 1e-3);
  EXPECT_TRUE(rays[2].hit) << "behind, it looks up and stays under the upper rim";
}

TEST(LevelPass, LeavesALevelRobotAlone) {
  std::vector<Ray> rays = {{1, 2, 0, true}};
  level_pass(
      {}, [](Time) { return Eigen::Quaterniond::Identity(); }, {}, rays);
  EXPECT_EQ(rays[0].range_m, 2.0F);
  EXPECT_EQ(rays[0].angle_rad, 1.0F);
}

TEST(EgomotionPass, OfNothingIsNothing) {
  const CorrectedScan corrected = egomotion_pass(Scan{}, {}, standing);
  EXPECT_TRUE(corrected.ends_lidar.empty());
  EXPECT_EQ(corrected.beam_step_rad, 0.0);
}

TEST(EgomotionPass, SortsBeamsInAnyOrder) {
  std::mt19937 random(3);
  Scan scan = look(
      two_rooms(), time_at_s(0),
      [](Time) {
        return Pose2{2, 2, 0};
      },
      {.turn_s = 0}, random);
  std::shuffle(scan.beams.begin(), scan.beams.end(), random);
  const CorrectedScan corrected = egomotion_pass(scan, clamp_pass(scan, {}), standing);
  EXPECT_TRUE(std::is_sorted(corrected.ends_lidar.begin(), corrected.ends_lidar.end(),
                             [](const RayEnd& a, const RayEnd& b) { return a.bearing_rad < b.bearing_rad; }));
}

TEST(StrayRayPass, DropsARayThroughAClosedWallAndKeepsOneThroughAGap) {
  std::mt19937 random(3);
  const auto at = [](Time) { return Pose2{2, 2, 0}; };
  Scan fine = look(two_rooms(), time_at_s(0), at, {.beams = 1200, .turn_s = 0}, random);
  Scan coarse = look(two_rooms(), time_at_s(0), at, {.beams = 90, .turn_s = 0}, random);
  fine.beams[10].range_m = 9.0F;
  fine.beams[500].range_m = 0.5F;
  coarse.beams[10].range_m = 9.0F;
  CorrectedScan f = egomotion_pass(fine, clamp_pass(fine, {}), standing);
  CorrectedScan c = egomotion_pass(coarse, clamp_pass(coarse, {}), standing);
  stray_ray_pass(f);
  stray_ray_pass(c);
  EXPECT_EQ(f.ends_lidar.size(), 1199U) << "the leg at half a metre stays";
  EXPECT_EQ(c.ends_lidar.size(), 90U);
}

}  // namespace
}  // namespace dynslam
