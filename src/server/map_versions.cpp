// SPDX-License-Identifier: MIT
#include "server/map_versions.h"

#include <functional>
#include <string_view>

namespace dynslam {

void MapVersions::update(const GridSnapshot& map, Time now) {
  const ChunkBox& box = map.box();
  for (std::int32_t y = box.min.y; y <= box.max.y; ++y) {
    for (std::int32_t x = box.min.x; x <= box.max.x; ++x) {
      const Chunk* chunk = map.find({x, y});
      if (!chunk || !is_sendable({x, y})) continue;
      Entry& entry = chunks_[{x, y}];
      if (entry.version > 0 && entry.grid_version == chunk->version) continue;
      const CodedCells cells = code_cells(*chunk);
      const std::size_t hash =
          std::hash<std::string_view>{}({reinterpret_cast<const char*>(cells.data()), cells.size()});
      if (entry.version == 0 || hash != entry.cells_hash)
        entry = {chunk->version, hash, entry.version + 1, now};
      entry.grid_version = chunk->version;
    }
  }
}

}  // namespace dynslam
