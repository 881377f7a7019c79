// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "plan/costmap.h"

namespace dynslam {

/// How far it is to everywhere that can be reached from a place, by coarse cells. Along steps in 16
/// directions: up to 2.8 % longer than the shortened route. A copy of what the costmap was.
class RouteLengths {
 public:
  /// Nothing was left out for being too far away.
  bool is_whole() const { return is_whole_; }
  /// Of the point's coarse cell; nothing where there is no way, or a longer one than was looked at.
  std::optional<double> length_m(const Vector2& point_map) const;
  /// The reached place nearest to a point; always one where the robot has room, and beside a lone post only
  /// where there is no other.
  std::optional<Vector2> nearest_reached(const Vector2& point_map, double within_m) const;
  /// Of all reached places the one farthest from a point, as the crow flies. Linear in the map's box.
  std::optional<Vector2> farthest_reached(const Vector2& point_map) const;
  /// Of the reached places so far from a point, as the crow flies, the one with the shortest way.
  std::optional<Vector2> reached_away_from(const Vector2& point_map, double least_m, double most_m) const;
  /// Whether the way there comes by a lone post, which may have a wide foot below the lidar.
  bool leads_by_post(const Vector2& point_map) const;
  /// From what is not reached so near to a point back along ground that had room once: the first reached
  /// place. It is before what shuts the way, as a door does. Where there never was a way, but ground to stand
  /// on, as of a room that was seen through a door that is ajar: the reached place nearest to the point.
  std::optional<Vector2> before_what_shuts(const Vector2& point_map, double within_m) const;

 private:
  friend class PathPlanner;
  static constexpr float kUnreached = std::numeric_limits<float>::infinity();
  void reset(const Costmap& costmap, std::uint8_t least_clearance);
  std::optional<Vector2> nearest(const Vector2& point_map, double within_m, bool by_posts) const;

  template <class Visit>
  void for_each_within(const Vector2& point_map, double within_m, Visit&& visit) const;

  double cell_size_m_ = 1.0;
  std::uint8_t least_clearance_ = 0;
  CoarseGrid grid_;
  std::vector<float> length_m_;
  std::vector<bool> leads_by_post_;
  bool is_whole_ = true;
};

}  // namespace dynslam
