// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "base/pose2.h"

namespace dynslam {

/// A route of straight legs, places along it told by the metres from its begin. Points that repeat are left
/// out.
class Route {
 public:
  struct Place {
    double along_m = 0.0;
    double away_m = 0.0;  ///< from the point asked about
  };
  struct Corner {
    double along_m;
    double turn_rad;  ///< 0: straight on; pi: back
  };

  Route() = default;
  /// REQUIRES: finite points.
  explicit Route(const std::vector<Vector2>& points);

  bool empty() const { return points_.empty(); }
  double length_m() const { return empty() ? 0.0 : along_.back(); }
  const Vector2& end() const { return points_.back(); }
  /// Before its begin is its begin, after its end its end. REQUIRES: not empty().
  Vector2 at(double along_m) const;
  /// Of the places between two, the nearest one. REQUIRES: not empty().
  Place nearest(const Vector2& p, double from_m, double to_m) const;
  /// The first place that is about as near as the nearest: a route may come by twice. REQUIRES: not empty().
  Place first_near(const Vector2& p) const;
  /// Between its ends, from one place to another, in order; neither included.
  std::vector<Corner> corners(double from_m, double to_m) const;
  /// How far ahead of a place a robot at `p` may steer, so that the straight line to there passes all corners
  /// before it within `cut_m`; at least `least_m`, at most `most_m`.
  double sight_m(const Vector2& p, double from_m, double least_m, double most_m, double cut_m) const;

 private:
  Place nearest_on_leg(const Vector2& p, std::size_t leg, double from_m, double to_m) const;

  std::vector<Vector2> points_;
  std::vector<double> along_;  ///< of each point
};

}  // namespace dynslam
