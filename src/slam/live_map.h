// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "grid/chunked_grid.h"
#include "slam/global_map.h"

namespace dynslam {

/// The map as it is now: what the back end has drawn, with the newest scans on top. When the back end has
/// drawn anew, what older scans left there is taken off again, so that nothing but finished work stays; what
/// the scans since the drawing before said last, two looks or more, is put on top once more: the back
/// end weighs a local map as a whole and is slow to see that something came or went. One thread.
class LiveMap {
 public:
  LiveMap(double cell_size_m, std::size_t max_chunks)
      : grid_(cell_size_m, max_chunks), recent_(cell_size_m, max_chunks, kRecentRule) {}

  /// The back end has drawn these chunks anew, and others need no change.
  void redrawn(std::span<const DrawnChunk> chunks);
  /// The back end has had its last word: shows what it drew and nothing else.
  void settle(std::span<const DrawnChunk> chunks);
  /// Lets up to so many of them in, oldest first.
  void show(std::size_t most_chunks);
  /// A scan, in the map's frame. A hit within two cells of a surface that is drawn already is a hit of that
  /// surface: ranges are not exact. For the same reason a surface is only missed with all cells around it.
  void draw(const ScanFootprint& scan);

  ChunkedGrid& grid() { return grid_; }
  const ChunkedGrid& grid() const { return grid_; }
  std::size_t waiting() const { return waiting_.size(); }

 private:
  /// The last two looks outweigh all before them.
  static constexpr CellRule kRecentRule{.gain = 64, .loss = 64};

  void forget_recent();
  DrawnChunk with_recent(ChunkIndex index) const;
  CellIndex surface_near(CellIndex hit) const;
  CellBitmap sparing_surfaces(const CellBitmap& misses) const;
  bool is_surface(CellIndex c) const;

  ChunkedGrid grid_;
  ChunkedGrid recent_;                      ///< the scans since the back end drew last
  std::map<ChunkIndex, DrawnChunk> drawn_;  ///< by the back end
  std::deque<DrawnChunk> waiting_;
  std::set<ChunkIndex> scanned_;  ///< chunks that scans changed since
  std::vector<CellIndex> hits_;
};

}  // namespace dynslam
