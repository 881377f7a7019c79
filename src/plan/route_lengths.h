// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "plan/costmap.h"

namespace dynslam {

/// How far it is to everywhere that can be reached from a place, by coarse cells. Along steps in 16
/// directions: up to 2.8 % longer than the shortened route. A copy of what the costmap was.
class RouteLengths {
 public:
  /// Of the point's coarse cell; nothing where there is no way, or a longer one than was looked at.
  std::optional<double> length_m(const Vector2& point_map) const;
  /// The reached place nearest to a point; always one where the robot has room, and beside a lone post only
  /// where there is no other.
  std::optional<Vector2> nearest_reached(const Vector2& point_map, double within_m) const;

 private:
  friend class PathPlanner;
  static constexpr float kUnreached = std::numeric_limits<float>::infinity();
  void reset(const Costmap& costmap);
  std::optional<Vector2> nearest(const Vector2& point_map, double within_m, bool by_posts) const;

  double cell_size_m_ = 1.0;
  CoarseGrid grid_;
  std::vector<float> length_m_;
};

}  // namespace dynslam
