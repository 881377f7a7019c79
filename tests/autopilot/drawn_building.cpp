// SPDX-License-Identifier: MIT
#include "autopilot/drawn_building.h"

#include <algorithm>
#include <stdexcept>

#include "base/angles.h"
#include "grid/ray_walk.h"

namespace dynslam {

DrawnBuilding::DrawnBuilding(std::vector<std::string> lines) : lines_(std::move(lines)) {
  std::reverse(lines_.begin(), lines_.end());
}

Vector2 DrawnBuilding::find(char letter) const {
  for (std::size_t row = 0; row < lines_.size(); ++row) {
    const std::size_t column = lines_[row].find(letter);
    if (column != std::string::npos)
      return kLetter_m * Vector2(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  }
  throw std::logic_error(std::string("there is no ") + letter);
}

bool DrawnBuilding::is_wall(const Vector2& point) const {
  const int row = floor_to_int(point.y() / kLetter_m), column = floor_to_int(point.x() / kLetter_m);
  if (row < 0 || row >= static_cast<int>(lines_.size())) return true;
  const std::string& line = lines_[static_cast<std::size_t>(row)];
  return column < 0 || column >= static_cast<int>(line.size()) ||
         walls_.contains(line[static_cast<std::size_t>(column)]);
}

void DrawnBuilding::set(CellIndex c, bool wall) {
  for (int look = 0; look < 10; ++look) wall ? grid_.add_hit(c) : grid_.add_miss(c);
}

void DrawnBuilding::look(const Vector2& from_map, double range_m) {
  constexpr int kRays = 1440;
  const double cell_m = grid_.cell_size_m();
  for (int i = 0; i < kRays; ++i) {
    const double angle = kTwoPi * i / kRays;
    bool over = false;
    walk_ray(from_map, from_map + range_m * Vector2(std::cos(angle), std::sin(angle)), cell_m,
             [&](CellIndex c) {
               if (over) return;
               over = is_wall(cell_centre(c, cell_m));
               if (grid_.state(c) != (over ? CellState::kOccupied : CellState::kFree)) set(c, over);
             });
  }
}

void DrawnBuilding::know_all() {
  const double cell_m = grid_.cell_size_m();
  const int per_letter = static_cast<int>(kLetter_m / cell_m + 0.5);
  for (int y = 0; y < per_letter * static_cast<int>(lines_.size()); ++y) {
    const auto width = static_cast<int>(lines_[static_cast<std::size_t>(y / per_letter)].size());
    for (int x = 0; x < per_letter * width; ++x) set({x, y}, is_wall(cell_centre({x, y}, cell_m)));
  }
}

WorldState DrawnBuilding::world(Time stamp, const Pose2& map_T_robot) {
  WorldState world;
  world.pose.stamp = stamp;
  world.pose.map_T_robot = map_T_robot;
  world.map = grid_.snapshot();
  return world;
}

}  // namespace dynslam
