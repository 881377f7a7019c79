// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "grid/world_state.h"

namespace dynslam {

/// A building drawn in letters, each a square of 20 cm, the last line at y = 0: '#' is wall, all else floor.
/// A robot in it sees what rays reach, and its map grows by that.
class DrawnBuilding {
 public:
  static constexpr double kLetter_m = 0.2;

  explicit DrawnBuilding(std::vector<std::string> lines);

  /// The middle of the first such letter. REQUIRES: there is one.
  Vector2 find(char letter) const;
  /// All such letters become walls, or floor.
  void wall_up(char letter) { walls_.insert(letter); }
  void open(char letter) { walls_.erase(letter); }
  bool is_wall(const Vector2& point) const;

  /// Adds to the map what is seen from there.
  void look(const Vector2& from_map, double range_m = 4.0);
  /// Adds all of it.
  void know_all();
  WorldState world(Time stamp, const Pose2& map_T_robot);

 private:
  void set(CellIndex c, bool wall);

  std::vector<std::string> lines_;  ///< the lowest first
  std::set<char> walls_{'#'};
  ChunkedGrid grid_{0.02};
};

}  // namespace dynslam
