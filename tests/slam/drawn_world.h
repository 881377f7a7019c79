// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "base/scan.h"

namespace dynslam {

/// A world of straight walls, small enough to see, and a lidar that looks at it.
struct DrawnWorld {
  struct Wall {
    Vector2 from, to;
  };
  std::vector<Wall> walls;

  void add_box(double x0, double y0, double x1, double y1) {
    const Vector2 a(x0, y0), b(x1, y0), c(x1, y1), d(x0, y1);
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}}) walls.push_back({from, to});
  }

  /// Distance from a point along a direction to the nearest wall; infinite where there is none.
  double distance(const Vector2& from, double direction) const {
    const Vector2 ray(std::cos(direction), std::sin(direction));
    double nearest = std::numeric_limits<double>::infinity();
    for (const Wall& w : walls) {
      const Vector2 along = w.to - w.from, off = w.from - from;
      const double cross = ray.x() * along.y() - ray.y() * along.x();
      if (std::abs(cross) < 1e-12) continue;
      const double range = (off.x() * along.y() - off.y() * along.x()) / cross;
      const double share = (off.x() * ray.y() - off.y() * ray.x()) / cross;
      if (range > 0 && share >= 0 && share <= 1) nearest = std::min(nearest, range);
    }
    return nearest;
  }
};

/// A flat of two rooms and a few things in them, 8 x 5 m, no two views alike. (Its outer walls lie off the
/// lines between cells: without noise, a wall on such a line is drawn half a cell off.)
inline DrawnWorld two_rooms() {
  DrawnWorld world;
  world.add_box(0.007, 0.011, 8.013, 5.009);
  world.walls.push_back({{4.5, 0}, {4.5, 2.0}});
  world.walls.push_back({{4.5, 2.9}, {4.5, 5}});
  world.add_box(1.0, 3.6, 1.9, 4.3);
  world.add_box(6.2, 0.5, 7.4, 1.1);
  world.add_box(2.8, 0.4, 3.1, 0.7);
  world.walls.push_back({{6.0, 5}, {7.0, 3.9}});
  return world;
}

struct DrawnLidar {
  int beams = 400;
  double turn_s = 0.08;  ///< 0: all beams at once
  double noise_m = 0.0;
};

/// What the lidar sees while the robot moves as `world_T_robot` says: each beam from where the robot is at
/// its time.
inline Scan look(const DrawnWorld& world, Time stamp, const std::function<Pose2(Time)>& world_T_robot,
                 const DrawnLidar& lidar, std::mt19937& random, const LidarMount& mount = {}) {
  std::normal_distribution<double> noise(0.0, 1.0);
  Scan scan;
  scan.stamp = stamp;
  scan.mount = mount;
  for (int i = 0; i < lidar.beams; ++i) {
    const double angle = -kPi + i * kTwoPi / lidar.beams, time_s = i * lidar.turn_s / lidar.beams;
    const Pose2 eye = world_T_robot(stamp + from_seconds(time_s)) * mount.robot_T_lidar;
    const double direction = eye.yaw + (mount.upside_down ? -angle : angle);
    const double range = world.distance(eye.translation(), direction) + lidar.noise_m * noise(random);
    scan.beams.push_back({static_cast<float>(angle), static_cast<float>(range), static_cast<float>(time_s)});
  }
  return scan;
}

}  // namespace dynslam
