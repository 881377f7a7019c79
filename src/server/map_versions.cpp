// SPDX-License-Identifier: MIT
#include "server/map_versions.h"

#include <cstdlib>
#include <functional>
#include <string_view>

namespace dynslam {
namespace {

/// A cell's state, and the higher half of how sure it is.
constexpr std::uint8_t kSeen = 0b1100'0100;

MapVersions::Look look_at(const Chunk& chunk) {
  CodedCells cells = code_cells(chunk);
  MapVersions::Look look;
  for (std::uint8_t& cell : cells) {
    look.occupied += cell >> 7;
    look.free += cell >> 6 & 1;
    cell &= kSeen;
  }
  look.hash = std::hash<std::string_view>{}({reinterpret_cast<const char*>(cells.data()), cells.size()});
  return look;
}

}  // namespace

void MapVersions::update(const GridSnapshot& map, Time now) {
  const ChunkBox& box = map.box();
  for (std::int32_t y = box.min.y; y <= box.max.y; ++y) {
    for (std::int32_t x = box.min.x; x <= box.max.x; ++x) {
      const Chunk* chunk = map.find({x, y});
      if (chunk && is_sendable({x, y})) update(chunks_[{x, y}], *chunk, now);
    }
  }
}

void MapVersions::update(Entry& entry, const Chunk& chunk, Time now) {
  if (entry.version > 0 && entry.grid_version == chunk.version) return;
  const Look look = look_at(chunk);
  if (entry.version > 0 && look.hash != entry.look.hash) {
    const int cells = std::abs(look.occupied - entry.look.occupied) + std::abs(look.free - entry.look.free);
    // Looked at again the next time, whether the grid changes or not.
    if (cells < kManyCells && now < entry.changed + kPatience) return;
  }
  if (entry.version == 0 || look.hash != entry.look.hash) entry = {0, look, entry.version + 1, now};
  entry.grid_version = chunk.version;
}

}  // namespace dynslam
