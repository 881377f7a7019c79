// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "server/map_versions.h"

namespace dynslam {

/// Which chunks a client gets next: those newer than it has, the nearest to the robot first. They are picked
/// in rounds: what changes again and again near the robot waits until the far ones had their turn too. Pure;
/// one thread, one for each client.
class MapDelivery {
 public:
  /// What the client has already.
  explicit MapDelivery(ChunkVersions has = {}) : has_(std::move(has)) {}

  struct Pick {
    ChunkIndex index;
    MapVersions::Entry entry;
  };
  /// The next chunks, `most` at most; from then on the client has them.
  std::vector<Pick> next(const MapVersions& versions, ChunkIndex robot, std::size_t most);
  /// Whether the last round is through; more may have changed meanwhile.
  bool round_done() const { return round_.empty(); }

 private:
  bool is_new(ChunkIndex index, const MapVersions::Entry& entry) const;
  void begin_round(const MapVersions& versions, ChunkIndex robot);

  ChunkVersions has_;
  std::deque<ChunkIndex> round_;
};

}  // namespace dynslam
