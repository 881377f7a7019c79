// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "autopilot/deep_cells.h"
#include "autopilot/exploration_config.h"
#include "autopilot/frontier.h"
#include "base/time.h"
#include "grid/chunked_grid.h"

namespace dynslam {

/// Keeps up with a map which of its cells are frontier cells: free cells beside (left, right, above, below)
/// the unknown (thesis 6.6). The unknown counts where a square of `least_depth_m` fits into it: what is
/// missed along walls and between beams is no frontier, nor is anything that is no room. Its ragged edge, and
/// what is seen of a room through a door that is ajar, counts with it: `deep_within_m` around, as far as a
/// square of `least_width_m` fits. What was occupied a moment ago and is unknown now counts as occupied for a
/// while: where people walked along a wall the map forgets both. The free counts where a square of
/// `least_width_m` fits into it: a lone ray that went through a wall is no way. It counts too just beyond a
/// gap less than half as wide, as there is between the last rays. Chunks that do not exist are unknown.
///
/// Memory: 1.1 KB a chunk, and the snapshot that was seen last. One thread.
class FrontierMap {
 public:
  explicit FrontierMap(const ExplorationConfig& config = {}) : config_(config) {}

  static constexpr Duration kForgotten = std::chrono::seconds(60);

  /// Looks at what changed since the last call, and around it. Returns how many chunks were done anew; a map
  /// of other cells begins anew.
  std::size_t update(Time now, const GridSnapshot& map);

  bool is_frontier(CellIndex c) const;
  /// All frontier cells, row by row.
  std::vector<CellIndex> cells() const;
  /// Where they make up something worth going to; `last_look`: or hardly. And what is left of such when half
  /// of it is seen.
  std::vector<Frontier> frontiers(bool last_look = false) const;
  /// How much of the unknown begins at a frontier and is as deep as counts; about a metre around at the most.
  double beyond_m2(const Frontier& frontier) const;

 private:
  struct Known {
    CellTile free, unknown;
  };
  struct RowByRow {
    bool operator()(ChunkIndex a, ChunkIndex b) const { return a.y != b.y ? a.y < b.y : a.x < b.x; }
  };

  using Tiles = std::map<ChunkIndex, CellTile>;
  void grow_old(Time now, std::set<ChunkIndex>& due);
  CellTile forgotten(ChunkIndex index) const;
  void look_at(ChunkIndex index, const Chunk* chunk, std::set<ChunkIndex>& due);
  void redo(ChunkIndex index);
  ChunkWindow wide_free(ChunkIndex index, const ChunkWindow& unknown) const;
  /// What is free counts so far beyond where it is wide, when there is but a gap between.
  int over_gap() const { return gap_ == 0 ? 0 : 2 * gap_ + 1; }
  /// How far what is unknown matters: as far as it is deep, or as a gap in what is free.
  int unknown_reach() const { return std::max(depth_ + within_, gap_ + width_ - 1 + over_gap()); }
  const Known& known(ChunkIndex index) const;
  ChunkWindow around(ChunkIndex index, CellTile Known::*cells) const;

  ExplorationConfig config_;
  // In cells: least_depth_m, deep_within_m, least_width_m, and the gap that is less than half of it.
  int depth_ = 1, within_ = 0, width_ = 1, gap_ = 0;
  GridSnapshot last_;                   ///< held, so that a chunk's address says which it is
  std::map<ChunkIndex, Known> known_;   ///< what is not in here is unknown
  Tiles forgotten_, forgotten_before_;  ///< what was occupied lately, and before that
  std::optional<Time> forgotten_since_;
  std::map<ChunkIndex, CellTile, RowByRow> cells_;  ///< no tile is clear
};

}  // namespace dynslam
