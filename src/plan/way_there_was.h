// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "plan/coarse_grid.h"

namespace dynslam {

/// From where there is no way now back along ground that had `least_clearance` steps of room once: the first
/// coarse cell on it that is reached. It lies before what shuts the way, as a door does. Nothing where there
/// never was one. `from`: indices of coarse cells; those that never had room do not count. Linear in the
/// cells it comes by.
std::optional<std::size_t> first_reached_by_way_there_was(const CoarseGrid& grid,
                                                          std::span<const std::size_t> from,
                                                          std::uint8_t least_clearance,
                                                          const std::function<bool(std::size_t)>& is_reached);

}  // namespace dynslam
