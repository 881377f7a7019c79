// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/pose2.h"
#include "base/time.h"
#include "grid/cell_index.h"

namespace dynslam {

/// The side of a cell of the history map (thesis 4.4): where the robot was is kept as such cells.
inline constexpr double kHistoryCell_m = 0.5;
/// No robot is farther than this from where it began.
inline constexpr double kWorld_m = 1e6;

/// When the robot was in which history cell last. Cells are in the map's frame as it was then: corrections of
/// the map do not move them. Beyond `most_cells` (some 130 bytes each) those left longest ago are forgotten.
/// One thread.
class VisitMap {
 public:
  explicit VisitMap(std::size_t most_cells = 32768) : most_cells_(most_cells) {}

  /// The robot is there now. Positions that are no numbers, or out of this world, are passed over.
  void note(Time now, const Vector2& position_map);
  std::optional<Time> last_visit(CellIndex history_cell) const;

  /// Oldest first; of the same time in the cells' order.
  const std::set<std::pair<Time, CellIndex>>& by_age() const { return by_age_; }

 private:
  std::size_t most_cells_;
  std::map<CellIndex, Time> last_visits_;
  std::set<std::pair<Time, CellIndex>> by_age_;
};

}  // namespace dynslam
