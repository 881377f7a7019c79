// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "base/pose2.h"
#include "grid/chunked_grid.h"
#include "grid/history_map.h"
#include "slam/finished_map.h"

namespace dynslam {

/// The map of everything, drawn from finished local maps where the pose graph has put them (thesis 4.1.5).
///
/// Each cell shows what the newest local map that knows it says. A map that is silent about a cell leaves
/// what older ones said, except right beside its own surfaces: an older wall drawn a cell or two behind a
/// newer one is the same wall. Work is counted in blocks, the cells of the history map: only those that
/// changed are drawn again, as many a turn as the caller allows. One thread; readers take snapshots of
/// grid().
class GlobalMap {
 public:
  static constexpr double kBlock_m = 0.5;  ///< side of a block

  explicit GlobalMap(double cell_size_m, std::size_t max_chunks) : grid_(cell_size_m, max_chunks) {}

  /// Puts in a map that is newer than all others; puts those that the pose graph moved where they
  /// belong now. Moves of less than a tenth of a cell are waited for.
  void place(std::shared_ptr<const FinishedMap> map, const Pose2& map_T_origin);
  void move(const std::map<std::uint32_t, Pose2>& map_T_origins);
  /// Takes a map out as if it had never been, to be replaced by a better version of itself.
  void remove(std::uint32_t id);

  /// Draws up to `most_blocks` of the blocks that changed; returns how many are left.
  std::size_t redraw(std::size_t most_blocks);

  /// Maps that no block needs any more; they are taken out. `keep` and newer ones stay in any case.
  std::vector<std::uint32_t> retire(std::uint32_t keep);

  std::size_t active() const { return maps_.size(); }
  ChunkedGrid& grid() { return grid_; }
  const ChunkedGrid& grid() const { return grid_; }

 private:
  /// A quarter of a metre of a map, and how many of its cells the map knows.
  struct Tile {
    Vector2 centre_drawn;
    int known = 0;
  };
  struct Placed {
    std::shared_ptr<const FinishedMap> map;
    std::shared_ptr<const CellBitmap> near_surface;  ///< cells within two of an occupied one
    std::vector<Tile> tiles;                         ///< those with known cells
    Pose2 map_T_origin;
    std::map<CellIndex, double> shares;  ///< of the blocks that it knows something of, where it is now
  };
  static std::vector<Tile> tiles_of(const FinishedMap& map);
  void cover(std::uint32_t id, Placed& placed);
  void uncover(Placed& placed);
  void rebuild_history();
  void draw(CellIndex block);

  ChunkedGrid grid_;
  std::map<std::uint32_t, Placed> maps_;
  HistoryMap history_;
  std::set<CellIndex> dirty_;
};

}  // namespace dynslam
