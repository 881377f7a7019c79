// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/drawn_frontiers.h"
#include "autopilot/exploration.h"

namespace dynslam {

using Rows = std::vector<std::string>;

/// A drawn map with a robot in it that gets through everything free, by steps up, down, left and right. 'R'
/// is where the robot is.
class ExploredFlat {
 public:
  explicit ExploredFlat(Rows rows) : rows_(std::move(rows)) {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const auto column = rows_[r].find('R');
      if (column == std::string::npos) continue;
      rows_[r][column] = '.';
      robot = cell_centre({static_cast<int>(column), static_cast<int>(rows_.size() - 1 - r)}, kLetter_m);
    }
    map = map_of(rows_);
    FrontierMap cells;
    cells.update({}, map);
    frontiers = cells.frontiers();
    spread();
  }

  Reachability reach() const {
    return {[this](const Vector2& p) -> std::optional<double> {
              const auto at = steps_.find(cell_at(p, kLetter_m));
              if (at == steps_.end()) return std::nullopt;
              return at->second * kLetter_m;
            },
            [this](const Vector2& p, double within_m) { return nearest(p, within_m); }};
  }

  Vector2 robot{0, 0};
  GridSnapshot map;
  std::vector<Frontier> frontiers;

 private:
  void spread() {
    std::deque<CellIndex> pending{cell_at(robot, kLetter_m)};
    steps_[pending.front()] = 0;
    while (!pending.empty()) {
      const CellIndex c = pending.front();
      pending.pop_front();
      for (const CellIndex n : {CellIndex{c.x + 1, c.y}, CellIndex{c.x - 1, c.y}, CellIndex{c.x, c.y + 1},
                                CellIndex{c.x, c.y - 1}}) {
        if (map.state(n) != CellState::kFree || steps_.contains(n)) continue;
        steps_[n] = steps_[c] + 1;
        pending.push_back(n);
      }
    }
  }
  std::optional<Vector2> nearest(const Vector2& p, double within_m) const {
    std::optional<Vector2> nearest;
    for (const auto& [cell, steps] : steps_) {
      const Vector2 centre = cell_centre(cell, kLetter_m);
      if ((centre - p).norm() <= within_m) nearest = centre, within_m = (centre - p).norm() - 1e-9;
    }
    return nearest;
  }

  Rows rows_;
  std::map<CellIndex, int> steps_;
};

/// A robot that explores a flat.
struct DrawnExplorer {
  explicit DrawnExplorer(const Rows& rows, const ExplorationConfig& config = {})
      : flat(rows), exploration(config) {}

  std::vector<Place> places() {
    return exploration.places(now, flat.robot, flat.frontiers, visits, flat.map, flat.reach());
  }
  void visit_all(Time at) {
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) visits.note(at, cell_centre({x, y}, kLetter_m));
    }
  }

  ExploredFlat flat;
  Exploration exploration;
  VisitMap visits;
  Time now = time_at_s(10000);
};

/// Doors into the unknown, 0.7 m to the left and 1 m far away to the right.
inline const Rows kTwoDoors = {
    "##############################",  //
    "#............................#",  //
    "........R.....................",  //
    "..............................",  //
    "..............................",  //
    "..............................",  //
    "..............................",  //
    "..............................",  //
    "..............................",  //
    "#............................#",  //
    "##############################",
};

inline const Rows kClosedRoom = {
    "####################",  //
    "#..................#",  //
    "#..................#",  //
    "#...R..............#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "####################",
};

}  // namespace dynslam
