// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "plan/coarse_grid.h"

namespace dynslam {

/// Ground that had room once.
struct GroundThereWas {
  /// The first coarse cell of it that is reached, when any is: it lies before what shuts the way, as a door
  /// does.
  std::optional<std::size_t> reached;
  std::size_t cells = 0;  ///< that were looked at until then
};

/// From where there is no way now along ground that had `least_clearance` steps of room once, the nearest
/// first. `from`: indices of coarse cells; those that never had room do not count. What is left out is gone
/// round. Linear in the cells it comes by.
GroundThereWas ground_there_was(
    const CoarseGrid& grid, std::span<const std::size_t> from, std::uint8_t least_clearance,
    const std::function<bool(std::size_t)>& is_reached,
    const std::function<bool(std::size_t)>& is_left_out = [](std::size_t) { return false; });

}  // namespace dynslam
