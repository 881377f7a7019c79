// SPDX-License-Identifier: MIT
#include "grid/history_map.h"

#include <algorithm>

namespace dynslam {

void HistoryMap::cover(CellIndex cell, std::uint32_t id, double share) {
  if (share <= 0) return;
  Stack& stack = cells_[cell];
  const auto at = std::lower_bound(stack.ids.begin(), stack.ids.end(), id, std::greater<>());
  const auto place = at - stack.ids.begin();
  if (at != stack.ids.end() && *at == id) {
    stack.covers[static_cast<std::size_t>(place)] = share >= kCovers;
  } else {
    stack.ids.insert(at, id);
    stack.covers.insert(stack.covers.begin() + place, share >= kCovers);
  }
  trim(stack);
}

/// Drops what no longer shows: everything below the last layer that covers the cell. Where too many saw a
/// little each, the oldest of these goes, never the ones that cover.
void HistoryMap::trim(Stack& stack) {
  std::size_t covering = 0;
  for (std::size_t i = 0; i < stack.ids.size(); ++i) {
    covering += stack.covers[i] ? 1 : 0;
    if (covering < kLayers) continue;
    stack.ids.resize(i + 1);
    stack.covers.resize(i + 1);
  }
  while (stack.ids.size() > kMostMaps) {
    std::size_t victim = stack.ids.size() - 1;
    while (victim > 0 && stack.covers[victim]) --victim;
    stack.ids.erase(stack.ids.begin() + static_cast<std::ptrdiff_t>(victim));
    stack.covers.erase(stack.covers.begin() + static_cast<std::ptrdiff_t>(victim));
  }
}

std::span<const std::uint32_t> HistoryMap::maps_at(CellIndex cell) const {
  const auto it = cells_.find(cell);
  return it == cells_.end() ? std::span<const std::uint32_t>()
                            : std::span<const std::uint32_t>(it->second.ids);
}

std::set<std::uint32_t> HistoryMap::named() const {
  std::set<std::uint32_t> ids;
  for (const auto& [cell, stack] : cells_) ids.insert(stack.ids.begin(), stack.ids.end());
  return ids;
}

}  // namespace dynslam
