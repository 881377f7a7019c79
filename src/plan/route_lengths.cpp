// SPDX-License-Identifier: MIT
#include "plan/route_lengths.h"

#include <algorithm>
#include <cmath>

namespace dynslam {

void RouteLengths::reset(const Costmap& costmap) {
  cell_size_m_ = costmap.cell_size_m();
  grid_ = costmap.coarse();
  length_m_.assign(grid_.size(), kUnreached);
}

std::optional<double> RouteLengths::length_m(const Vector2& point_map) const {
  const Vector2 cell = point_map / cell_size_m_;
  if (!(cell.cwiseAbs().maxCoeff() < std::numeric_limits<std::int32_t>::max())) return std::nullopt;
  const CellIndex c = cell_at(point_map, cell_size_m_);
  if (!grid_.contains(c)) return std::nullopt;
  const float length = length_m_[grid_.index_of(c)];
  return length < kUnreached ? std::optional<double>(length) : std::nullopt;
}

std::optional<Vector2> RouteLengths::nearest_reached(const Vector2& point_map, double within_m) const {
  const auto roomy = nearest(point_map, within_m, false);
  return roomy.has_value() ? roomy : nearest(point_map, within_m, true);
}

std::optional<Vector2> RouteLengths::nearest(const Vector2& point_map, double within_m, bool by_posts) const {
  if (!point_map.allFinite() || !(within_m >= 0) || grid_.box().empty()) return std::nullopt;
  const CellIndex low = first_cell(grid_.box().min);
  const CellIndex high = first_cell({grid_.box().max.x + 1, grid_.box().max.y + 1});
  const auto clamped = [&](double m, std::int32_t from, std::int32_t to) {
    return static_cast<std::int32_t>(std::clamp(std::floor(m / cell_size_m_), double(from), to - 1.0));
  };
  std::optional<Vector2> nearest;
  double least_m = within_m;
  const int last_y = clamped(point_map.y() + within_m, low.y, high.y);
  const int last_x = clamped(point_map.x() + within_m, low.x, high.x);
  for (int y = clamped(point_map.y() - within_m, low.y, high.y) & ~(kCoarseSide - 1); y <= last_y;
       y += kCoarseSide) {
    for (int x = clamped(point_map.x() - within_m, low.x, high.x) & ~(kCoarseSide - 1); x <= last_x;
         x += kCoarseSide) {
      const std::size_t index = grid_.index_of({x, y});
      if (length_m_[index] == kUnreached || (!by_posts && grid_[index].by_post())) continue;
      const Vector2 centre = cell_centre(grid_.best_cell(index), cell_size_m_);
      const double distance_m = (centre - point_map).norm();
      if (distance_m > least_m || (nearest && distance_m == least_m)) continue;
      nearest = centre;
      least_m = distance_m;
    }
  }
  return nearest;
}

}  // namespace dynslam
