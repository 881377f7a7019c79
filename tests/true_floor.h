// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "plan/costmap.h"
#include "sim/ray_caster.h"
#include "sim/world.h"

namespace dynslam {

/// The floor of a world in which nothing moves, and what of it a robot has seen. World frame; cells of 10 cm.
class TrueFloor {
 public:
  /// REQUIRES: no people, no schedules, no moves.
  explicit TrueFloor(const World& world);

  /// Sees what the beams of a lidar reach from there.
  void look(const Vector2& from, double range_m);
  /// Seen cells beside a patch of unseen ones that is as large as what an explorer cares for.
  std::vector<std::size_t> frontier() const;
  /// Whether it is seen, and a neighbour is not.
  bool is_frontier(std::size_t cell) const;
  Vector2 middle(std::size_t cell) const;
  double seen_share() const;
  const Costmap& costmap() const { return costmap_; }

  static constexpr double kCell_m = 0.1;

 private:
  enum class Look : std::uint8_t { kNoFloor, kUnseen, kSeen };
  void draw_costmap(const std::vector<Surface>& surfaces);
  void find_floor(const World& world);
  template <class Visit>
  void for_each_beside(std::size_t cell, Visit&& visit) const;
  std::vector<bool> large_patches() const;

  RayCaster caster_;
  Costmap costmap_{kCell_m / kCoarseSide};
  Vector2 low_ = Vector2::Zero();  ///< the middle of cell 0
  std::size_t columns_ = 0;
  std::vector<Look> cells_;  ///< row by row; the outermost ones are no floor
};

}  // namespace dynslam
