// SPDX-License-Identifier: MIT
#include "plan/route_lengths.h"

#include <algorithm>
#include <cmath>

#include "plan/ground_there_was.h"

namespace dynslam {
namespace {

/// So much ground is somewhere to be.
constexpr double kRoom_m2 = 0.25;
/// As far as one sees of a room through a gap.
constexpr double kThroughGap_m = 3.0;

}  // namespace

void RouteLengths::reset(const Costmap& costmap, std::uint8_t least_clearance) {
  least_clearance_ = least_clearance;
  cell_size_m_ = costmap.cell_size_m();
  grid_ = costmap.coarse();
  length_m_.assign(grid_.size(), kUnreached);
  leads_by_post_.assign(grid_.size(), false);
  is_whole_ = true;
}

std::optional<double> RouteLengths::length_m(const Vector2& point_map) const {
  const Vector2 cell = point_map / cell_size_m_;
  if (!(cell.cwiseAbs().maxCoeff() < std::numeric_limits<std::int32_t>::max())) return std::nullopt;
  const CellIndex c = cell_at(point_map, cell_size_m_);
  if (!grid_.contains(c)) return std::nullopt;
  const float length = length_m_[grid_.index_of(c)];
  return length < kUnreached ? std::optional<double>(length) : std::nullopt;
}

bool RouteLengths::leads_by_post(const Vector2& point_map) const {
  return length_m(point_map) && leads_by_post_[grid_.index_of(cell_at(point_map, cell_size_m_))];
}

std::optional<Vector2> RouteLengths::nearest_reached(const Vector2& point_map, double within_m) const {
  const auto roomy = nearest(point_map, within_m, false);
  return roomy.has_value() ? roomy : nearest(point_map, within_m, true);
}

std::optional<Vector2> RouteLengths::nearest(const Vector2& point_map, double within_m, bool by_posts) const {
  std::optional<Vector2> nearest;
  double least_m = within_m;
  for_each_within(point_map, within_m, [&](std::size_t index) {
    if (length_m_[index] == kUnreached || (!by_posts && grid_[index].by_post())) return;
    const Vector2 centre = cell_centre(grid_.best_cell(index), cell_size_m_);
    const double distance_m = (centre - point_map).norm();
    if (distance_m > least_m || (nearest && distance_m == least_m)) return;
    nearest = centre;
    least_m = distance_m;
  });
  return nearest;
}

std::optional<Vector2> RouteLengths::farthest_reached(const Vector2& point_map) const {
  std::optional<Vector2> farthest;
  double most_m = 0.0;
  for (std::size_t i = 0; i < length_m_.size(); ++i) {
    if (length_m_[i] == kUnreached) continue;
    const Vector2 centre = cell_centre(grid_.best_cell(i), cell_size_m_);
    const double distance_m = (centre - point_map).norm();
    if (farthest && distance_m <= most_m) continue;
    farthest = centre;
    most_m = distance_m;
  }
  return farthest;
}

std::optional<Vector2> RouteLengths::reached_away_from(const Vector2& point_map, double least_m,
                                                       double most_m) const {
  std::optional<Vector2> best;
  float shortest_m = kUnreached;
  for_each_within(point_map, most_m, [&](std::size_t index) {
    if (length_m_[index] >= shortest_m) return;
    const Vector2 centre = cell_centre(grid_.best_cell(index), cell_size_m_);
    const double distance_m = (centre - point_map).norm();
    if (distance_m < least_m || distance_m > most_m) return;
    best = centre;
    shortest_m = length_m_[index];
  });
  return best;
}

std::optional<Vector2> RouteLengths::before_what_shuts(const Vector2& point_map, double within_m) const {
  std::vector<std::size_t> around;
  for_each_within(point_map, within_m, [&](std::size_t index) {
    if (length_m_[index] == kUnreached) around.push_back(index);
  });
  const GroundThereWas ground = ground_there_was(
      grid_, around, least_clearance_, [&](std::size_t index) { return length_m_[index] < kUnreached; });
  if (ground.reached) return cell_centre(grid_.best_cell(*ground.reached), cell_size_m_);
  const double coarse_m = kCoarseSide * cell_size_m_;
  const bool is_room = static_cast<double>(ground.cells) * coarse_m * coarse_m >= kRoom_m2;
  return is_room ? nearest_reached(point_map, kThroughGap_m) : std::nullopt;
}

/// The coarse cells of a square.
template <class Visit>
void RouteLengths::for_each_within(const Vector2& point_map, double within_m, Visit&& visit) const {
  if (!point_map.allFinite() || !(within_m >= 0) || grid_.box().empty()) return;
  const CellIndex low = first_cell(grid_.box().min);
  const CellIndex high = first_cell({grid_.box().max.x + 1, grid_.box().max.y + 1});
  const auto clamped = [&](double m, std::int32_t from, std::int32_t to) {
    return static_cast<std::int32_t>(std::clamp(std::floor(m / cell_size_m_), double(from), to - 1.0));
  };
  const int last_y = clamped(point_map.y() + within_m, low.y, high.y);
  const int last_x = clamped(point_map.x() + within_m, low.x, high.x);
  for (int y = clamped(point_map.y() - within_m, low.y, high.y) & ~(kCoarseSide - 1); y <= last_y;
       y += kCoarseSide) {
    for (int x = clamped(point_map.x() - within_m, low.x, high.x) & ~(kCoarseSide - 1); x <= last_x;
         x += kCoarseSide)
      visit(grid_.index_of({x, y}));
  }
}

}  // namespace dynslam
