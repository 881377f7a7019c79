// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "grid/cell_index.h"

namespace dynslam {

/// Which local maps tell of which place (thesis 4.1.5): for each cell of half a metre, the newest map that
/// covers most of it, and those around it in time that are needed to draw it. A newer map that saw less of a
/// place does not take it over (the thesis's figure 5.3): it is drawn on top, and the one that saw all stays
/// underneath. Map ids are counted up: a larger one is newer. One thread.
class HistoryMap {
 public:
  static constexpr double kCovers =
      0.75;  ///< share of a cell that a map must know to be the one that names it
  static constexpr std::size_t kLayers =
      6;  ///< maps that cover a cell, one over the other: what the newest left open
  static constexpr std::size_t kMostMaps = 24;  ///< kept for a cell

  /// Map `id` knows `share` (0 to 1) of a cell.
  void cover(CellIndex cell, std::uint32_t id, double share);

  /// The maps that draw a cell, newest first: down to the kLayers-th that covers most of it. Empty where no
  /// map was.
  std::span<const std::uint32_t> maps_at(CellIndex cell) const;

  /// All maps that some cell needs.
  std::set<std::uint32_t> named() const;

  void clear() { cells_.clear(); }
  std::size_t size() const { return cells_.size(); }

 private:
  struct Stack {
    std::vector<std::uint32_t> ids;  ///< newest first
    std::vector<bool> covers;        ///< of each
  };
  static void trim(Stack& stack);

  std::map<CellIndex, Stack> cells_;
};

}  // namespace dynslam
