// SPDX-License-Identifier: MIT
#include "plan/way_out.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>

namespace dynslam {
namespace {

/// Of a start that shows as occupied: the robot is there, so nothing else is.
constexpr double kOwnBody_m = 0.1;
/// A passage beside a bed is two metres long.
constexpr double kReach_m = 2.5, kReachInForbidden_m = 8.0;
/// How many times as much a step costs where there is no room at all.
constexpr int kTightness = 5;

/// Dijkstra over the cells around the start.
class WayOut {
 public:
  using LeadsOn = std::function<bool(std::size_t)>;
  /// It may be null: everywhere.
  WayOut(const Costmap& map, const Ground& ground, CellIndex start, const LeadsOn& leads_on)
      : map_(map),
        ground_(ground),
        start_(start),
        leads_on_(leads_on),
        least_steps_(leads_on ? ground.least_clearance() / 2 : 0),
        radius_(static_cast<int>(way_out_reach_m(map, cell_centre(start, map.cell_size_m())) /
                                 map.cell_size_m())),
        own_body_(map.is_occupied(start) ? static_cast<int>(kOwnBody_m / map.cell_size_m()) : 0),
        leaves_forbidden_(map.is_forbidden(start)) {}

  /// The cells from the start to the end.
  std::optional<std::vector<CellIndex>> find() {
    if (is_out(start_)) return std::vector<CellIndex>{start_};
    nodes_.resize(static_cast<std::size_t>(side() * side()));
    offer(start_, start_, 0);
    while (!queue_.empty()) {
      const auto [cost, place] = queue_.top();
      queue_.pop();
      const CellIndex cell = cell_of(place);
      if (cost != node(cell).cost) continue;
      if (is_out(cell)) return way_to(cell);
      expand(cell, cost);
    }
    return std::nullopt;
  }

 private:
  static constexpr int kNever = 1 << 30;
  struct Node {
    int cost = kNever;
    CellIndex before;
  };
  int side() const { return 2 * radius_ + 1; }
  int place_of(CellIndex c) const { return (c.y - start_.y + radius_) * side() + c.x - start_.x + radius_; }
  CellIndex cell_of(int place) const {
    return {place % side() + start_.x - radius_, place / side() + start_.y - radius_};
  }
  Node& node(CellIndex c) { return nodes_[static_cast<std::size_t>(place_of(c))]; }

  bool is_out(CellIndex c) const {
    const CoarseGrid& grid = map_.coarse();
    const std::size_t coarse = grid.index_of(c);
    return map_.clearance_steps(c) >= ground_.least_clearance() && ground_.price(grid[coarse]) != 0 &&
           (!leads_on_ || leads_on_(coarse));
  }
  bool is_passable(CellIndex c) const {
    const int dx = c.x - start_.x, dy = c.y - start_.y, square = dx * dx + dy * dy;
    if (square > radius_ * radius_ || !map_.contains(c)) return false;
    if (map_.clearance_steps(c) < least_steps_) return false;
    if (map_.is_forbidden(c) && !leaves_forbidden_) return false;
    return square <= own_body_ * own_body_ || !map_.is_occupied(c);
  }
  void expand(CellIndex c, int cost) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const CellIndex to{c.x + dx, c.y + dy};
        if (!is_passable(to) || !is_passable({to.x, c.y}) || !is_passable({c.x, to.y})) continue;
        const int least = ground_.least_clearance();
        const int lacking = std::max(0, least - map_.clearance_steps(to));
        const int price = 16 + 16 * (kTightness - 1) * lacking / least;
        offer(to, c, cost + (dx != 0 && dy != 0 ? 181 : 128) * price);
      }
    }
  }
  void offer(CellIndex to, CellIndex before, int cost) {
    if (cost >= node(to).cost) return;
    node(to) = {cost, before};
    queue_.push({cost, place_of(to)});
  }
  std::vector<CellIndex> way_to(CellIndex end) {
    std::vector<CellIndex> way{end};
    while (way.back() != start_) way.push_back(node(way.back()).before);
    std::reverse(way.begin(), way.end());
    return way;
  }

  using Entry = std::pair<int, int>;  ///< cost, place
  const Costmap& map_;
  const Ground& ground_;
  CellIndex start_;
  const LeadsOn& leads_on_;
  int least_steps_;
  int radius_, own_body_;  ///< cells
  bool leaves_forbidden_;
  std::vector<Node> nodes_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

bool goes_straight(CellIndex a, CellIndex b, CellIndex c) {
  return b.x - a.x == c.x - b.x && b.y - a.y == c.y - b.y;
}

}  // namespace

double way_out_reach_m(const Costmap& map, const Vector2& start_map) {
  return map.is_forbidden(cell_at(start_map, map.cell_size_m())) ? kReachInForbidden_m : kReach_m;
}

std::optional<std::vector<Vector2>> way_out_to(const std::function<bool(std::size_t)>& leads_on,
                                               const Costmap& map, const Ground& ground,
                                               const Vector2& start_map) {
  const auto cells = WayOut(map, ground, cell_at(start_map, map.cell_size_m()), leads_on).find();
  if (!cells) return std::nullopt;
  std::vector<Vector2> way{start_map};
  for (std::size_t i = 1; i < cells->size(); ++i) {
    const bool passes = i + 1 < cells->size() && goes_straight((*cells)[i - 1], (*cells)[i], (*cells)[i + 1]);
    if (!passes) way.push_back(cell_centre((*cells)[i], map.cell_size_m()));
  }
  return way;
}

std::optional<std::vector<Vector2>> way_out(const Costmap& map, const Ground& ground,
                                            const Vector2& start_map) {
  return way_out_to(nullptr, map, ground, start_map);
}

}  // namespace dynslam
