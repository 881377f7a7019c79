// SPDX-License-Identifier: MIT
#include "plan/ground_there_was.h"

#include <algorithm>
#include <vector>

namespace dynslam {

GroundThereWas ground_there_was(const CoarseGrid& grid, std::span<const std::size_t> from,
                                std::uint8_t least_clearance,
                                const std::function<bool(std::size_t)>& is_reached,
                                const std::function<bool(std::size_t)>& is_left_out) {
  const auto had_room = [&](std::size_t index) { return grid[index].once >= least_clearance; };
  if (std::none_of(from.begin(), from.end(), had_room)) return {};
  std::vector<bool> seen(grid.size());
  std::vector<std::size_t> wave;
  const auto offer = [&](std::size_t index) {
    if (seen[index] || !had_room(index)) return;
    seen[index] = true;
    if (!is_left_out(index)) wave.push_back(index);
  };
  for (const std::size_t index : from) offer(index);
  const auto stride = static_cast<std::size_t>(grid.stride());
  for (std::size_t i = 0; i < wave.size(); ++i) {
    const std::size_t at = wave[i];
    if (is_reached(at)) return {at, i + 1};
    for (const std::size_t next : {at - 1, at + 1, at - stride, at + stride}) offer(next);
  }
  return {std::nullopt, wave.size()};
}

}  // namespace dynslam
