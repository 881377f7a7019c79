// SPDX-License-Identifier: MIT
#include "server/map_delivery.h"

#include <algorithm>

namespace dynslam {
namespace {

std::int64_t square_distance(ChunkIndex a, ChunkIndex b) {
  const std::int64_t dx = std::int64_t{a.x} - b.x, dy = std::int64_t{a.y} - b.y;
  return dx * dx + dy * dy;
}

}  // namespace

bool MapDelivery::is_new(ChunkIndex index, const MapVersions::Entry& entry) const {
  const auto known = has_.find(index);
  return known == has_.end() || known->second != entry.version;
}

void MapDelivery::begin_round(const MapVersions& versions, ChunkIndex robot) {
  for (const auto& [index, entry] : versions.chunks())
    if (is_new(index, entry)) round_.push_back(index);
  std::stable_sort(round_.begin(), round_.end(), [&](ChunkIndex a, ChunkIndex b) {
    return square_distance(a, robot) < square_distance(b, robot);
  });
}

std::vector<MapDelivery::Pick> MapDelivery::next(const MapVersions& versions, ChunkIndex robot,
                                                 std::size_t most) {
  if (round_.empty()) begin_round(versions, robot);
  std::vector<Pick> picks;
  while (!round_.empty() && picks.size() < most) {
    const ChunkIndex index = round_.front();
    round_.pop_front();
    const auto found = versions.chunks().find(index);
    if (found == versions.chunks().end() || !is_new(index, found->second)) continue;
    picks.push_back({index, found->second});
    has_[index] = found->second.version;
  }
  return picks;
}

}  // namespace dynslam
