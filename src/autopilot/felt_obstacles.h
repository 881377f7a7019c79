// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <vector>

#include "base/pose2.h"
#include "base/time.h"
#include "base/twist.h"

namespace dynslam {

/// What the robot ran into and its lidar does not see: kept out of for a while, as are areas that people
/// drew. Where along its front it touched is a guess: in the middle; if that shuts the way, on the left, then
/// on the right. What it ran into at places near to each other is one thing: it shuts the way between them
/// too, and is kept away from the farther the more often it was touched. In the map's frame as it was then.
/// One thread.
class FeltObstacles {
 public:
  /// It touched something, driving like this.
  void touched(Time now, const Pose2& map_T_robot, const Twist& driven, double robot_radius_m);
  /// Forgets what was long ago; returns whether there was any such.
  bool forget(Time now);
  /// They seem to shut the way: guesses the next place for the last of them that has one left; without it
  /// counts for nothing until trust(). Returns whether that changes anything.
  bool doubt();
  /// What counted for nothing counts again. Returns whether that changes anything.
  bool trust();

  /// Touches since `since`.
  std::size_t count_since(Time since) const;
  /// Outlines in the map, all convex; a turn on the spot leaves none, for nobody knows on which side it
  /// touched.
  std::vector<std::vector<Vector2>> outlines_map() const;

 private:
  struct Felt {
    Time time;
    std::vector<Vector2> guesses_map;  ///< where it may be, the likeliest first
    std::size_t guess = 0;             ///< as many as there are: none is left
    bool counts() const { return guess < guesses_map.size(); }
  };
  std::deque<Felt> felt_;
};

}  // namespace dynslam
