// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <vector>

#include "base/pose2.h"
#include "base/time.h"
#include "base/twist.h"

namespace dynslam {

/// What the robot ran into and its lidar does not see: kept out of for a while, as are areas that people
/// drew. In the map's frame as it was then. One thread.
class FeltObstacles {
 public:
  /// It touched something, driving like this.
  void touched(Time now, const Pose2& map_T_robot, const Twist& driven, double robot_radius_m);
  /// Forgets what was long ago; returns whether there was any such.
  bool forget(Time now);
  /// It seems to shut the way, and was a guess: it counts for nothing until trust() or the next touch.
  /// Returns whether that changes anything.
  bool doubt();
  /// It was not that. Returns whether that changes anything.
  bool trust();

  /// Touches since `since`.
  std::size_t count_since(Time since) const;
  /// Outlines in the map; a turn on the spot leaves none, for nobody knows on which side it touched.
  std::vector<std::vector<Vector2>> outlines_map() const;

 private:
  struct Felt {
    Time time;
    std::vector<Vector2> outline_map;
  };
  std::deque<Felt> felt_;
  bool doubted_ = false;
};

}  // namespace dynslam
