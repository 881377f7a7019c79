// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "base/scan.h"

namespace dynslam {

/// A world of straight walls and round things, in the robot's frame unless said otherwise.
struct DrawnWorld {
  struct Wall {
    double x0, y0, x1, y1;
  };
  struct Post {
    double x, y, radius;
  };
  std::vector<Wall> walls;
  std::vector<Post> posts;
};

/// How far from (0, 0) of `world_T_lidar` a ray meets something; infinite when it does not.
inline double cast(const DrawnWorld& world, const Pose2& world_T_lidar, double angle) {
  const double c = std::cos(world_T_lidar.yaw + angle), s = std::sin(world_T_lidar.yaw + angle);
  double range = std::numeric_limits<double>::infinity();
  for (const auto& w : world.walls) {
    const double ex = w.x1 - w.x0, ey = w.y1 - w.y0, dx = w.x0 - world_T_lidar.x, dy = w.y0 - world_T_lidar.y;
    const double cross = c * ey - s * ex;
    if (std::abs(cross) < 1e-12) continue;
    const double along_ray = (dx * ey - dy * ex) / cross, along_wall = (dx * s - dy * c) / cross;
    if (along_ray > 0 && along_wall >= 0 && along_wall <= 1) range = std::min(range, along_ray);
  }
  for (const auto& p : world.posts) {
    const double dx = p.x - world_T_lidar.x, dy = p.y - world_T_lidar.y;
    const double ahead = c * dx + s * dy, beside = c * dy - s * dx;
    const double half = p.radius * p.radius - beside * beside;
    if (half >= 0 && ahead - std::sqrt(half) > 0) range = std::min(range, ahead - std::sqrt(half));
  }
  return range;
}

/// A whole turn of evenly spaced beams, all taken at once from where the robot is, in the middle of it.
inline Scan scan_of(const DrawnWorld& world, Time stamp = {}, std::size_t beams = 1200,
                    const Pose2& world_T_robot = {}) {
  Scan scan;
  scan.stamp = stamp;
  for (std::size_t i = 0; i < beams; ++i) {
    const double angle = kTwoPi * (static_cast<double>(i) + 0.5) / static_cast<double>(beams);
    scan.beams.push_back(
        {static_cast<float>(angle), static_cast<float>(cast(world, world_T_robot, angle)), 0.0F});
  }
  return scan;
}

/// What an A3 sees of it: nothing nearer than 0.2 m.
inline Scan as_a3(Scan scan) {
  for (Beam& beam : scan.beams)
    if (beam.range_m < 0.2F) beam.range_m = std::numeric_limits<float>::infinity();
  return scan;
}

/// A long wall across the way, so far from the middle of the robot; ahead when positive.
inline DrawnWorld wall_at(double x) { return {{{x, -5, x, 5}}, {}}; }

/// The same scan, its ranges off by up to a tenth of a millimetre, as no two real scans are alike.
inline std::shared_ptr<const Scan> shaken(const Scan& scan, Time stamp, std::mt19937& random) {
  auto copy = std::make_shared<Scan>(scan);
  copy->stamp = stamp;
  std::uniform_real_distribution<float> off(-1e-4F, 1e-4F);
  for (Beam& beam : copy->beams) beam.range_m += off(random);
  return copy;
}

}  // namespace dynslam
