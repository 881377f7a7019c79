// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>

#include "grid/chunked_grid.h"
#include "server/map_message.h"

namespace dynslam {

/// When each chunk, as clients see it, changed last. The grid counts every write; most change nothing that
/// can be seen, and need not be sent. One for all clients; one thread at a time.
///
/// At the edge of a wall that is looked at again and again some cells go to and fro, and all get surer bit by
/// bit. A change of a few cells therefore counts only every kPatience; one of more, such as somebody makes
/// who comes in, at once.
///
/// Memory: about 100 bytes a chunk.
class MapVersions {
 public:
  static constexpr Duration kPatience = std::chrono::seconds(2);
  static constexpr int kManyCells = 8;

  /// What is to be seen in a chunk, in short.
  struct Look {
    std::uint64_t hash = 0;  ///< of each cell's state and whether that is sure
    int occupied = 0, free = 0;
  };
  struct Entry {
    std::uint64_t grid_version = 0;
    Look look;
    std::uint32_t version = 0;
    Time changed;
  };

  /// Takes in what the map looks like now.
  void update(const GridSnapshot& map, Time now);
  const std::map<ChunkIndex, Entry>& chunks() const { return chunks_; }

 private:
  static void update(Entry& entry, const Chunk& chunk, Time now);

  std::map<ChunkIndex, Entry> chunks_;
};

}  // namespace dynslam
