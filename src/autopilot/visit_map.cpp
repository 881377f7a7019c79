// SPDX-License-Identifier: MIT
#include "autopilot/visit_map.h"

namespace dynslam {

void VisitMap::note(Time now, const Vector2& position_map) {
  if (!position_map.allFinite() || position_map.cwiseAbs().maxCoeff() >= kWorld_m) return;
  const CellIndex cell = cell_at(position_map, kHistoryCell_m);
  const auto [visit, is_new] = last_visits_.try_emplace(cell, now);
  if (!is_new) {
    by_age_.erase({visit->second, cell});
    visit->second = now;
  }
  by_age_.insert({now, cell});
  if (last_visits_.size() <= most_cells_) return;
  last_visits_.erase(by_age_.begin()->second);
  by_age_.erase(by_age_.begin());
}

std::optional<Time> VisitMap::last_visit(CellIndex history_cell) const {
  const auto visit = last_visits_.find(history_cell);
  if (visit == last_visits_.end()) return std::nullopt;
  return visit->second;
}

}  // namespace dynslam
