// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>

#include "grid/chunked_grid.h"
#include "server/map_message.h"

namespace dynslam {

/// When the cells of each chunk, as clients see them, changed last. The grid counts every write; most change
/// nothing that can be seen, and need not be sent. One for all clients; one thread at a time.
///
/// Memory: about 90 bytes a chunk.
class MapVersions {
 public:
  struct Entry {
    std::uint64_t grid_version = 0;
    std::uint64_t cells_hash = 0;
    std::uint32_t version = 0;
    Time changed;
  };

  /// Takes in what the map looks like now.
  void update(const GridSnapshot& map, Time now);
  const std::map<ChunkIndex, Entry>& chunks() const { return chunks_; }

 private:
  std::map<ChunkIndex, Entry> chunks_;
};

}  // namespace dynslam
