// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "plan/costmap.h"
#include "plan/planner_config.h"

namespace dynslam {

/// Whether a way may cross ground that nobody has seen.
enum class Unknown { kForbidden, kDear };

/// Where the robot may be and what a metre costs there: 1 where there is room, more where it is tight or
/// unknown, rising evenly from the comfortable clearance down to the least one, and much more by a post.
class Ground {
 public:
  /// A price of one.
  static constexpr int kUnit = 16;
  static constexpr int kMostPrice = 64 * kUnit;

  /// At least `least_clearance_m` from the robot's centre to whatever is blocked.
  Ground(const PlannerConfig& config, double least_clearance_m, Unknown unknown);

  /// In kUnit; 0: no way.
  std::uint16_t price(const CoarseCell& cell, std::uint8_t clearance) const {
    return prices_[(cell.known() ? 1U : 0U) | (cell.by_post() ? 2U : 0U)][clearance];
  }
  std::uint16_t price(const CoarseCell& cell) const { return price(cell, cell.clearance); }
  std::uint8_t least_clearance() const { return least_clearance_; }

 private:
  std::uint8_t least_clearance_;                            ///< steps
  std::array<std::array<std::uint16_t, 256>, 4> prices_{};  ///< bit 0: known, bit 1: by a post
};

/// The clearance in steps that is surely as much as that in metres.
std::uint8_t clearance_steps_for(double clearance_m);

/// What the straight leg costs, in metres of easy ground; nothing when a cell that it touches is no way. Of
/// what is known the coarse cell decides, as in the search. The same both ways. REQUIRES: both ends lie in
/// the map's box.
std::optional<double> leg_cost(const Costmap& map, const Ground& ground, const Vector2& from_map,
                               const Vector2& to_map);

}  // namespace dynslam
