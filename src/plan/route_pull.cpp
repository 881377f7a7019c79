// SPDX-License-Identifier: MIT
#include "plan/route_pull.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr int kRounds = 6;  // even: the route ends the right way round
/// A leg may cost a little more if that saves a point: the costs are sums over cells.
constexpr double kSlack = 1.001;

/// One way along the route, with points at most so far apart.
class Shortener {
 public:
  Shortener(const std::vector<Vector2>& route, double spacing_m, const Costmap& map, const Ground& ground)
      : map_(map), ground_(ground), route_{route.front()}, cost_{0.0} {
    for (std::size_t i = 1; i < route.size(); ++i) {
      const double length_m = (route[i] - route[i - 1]).norm();
      const int parts = std::max(1, static_cast<int>(std::ceil(length_m / spacing_m)));
      if (!add_leg(route[i], parts)) add_leg(route[i], 1);
    }
  }

  std::vector<Vector2> run() const {
    std::vector<Vector2> kept{route_.front()};
    for (std::size_t at = 0; at + 1 < route_.size();) kept.push_back(route_[at = farthest_from(at)]);
    return kept;
  }

 private:
  /// False, and nothing added, when a part is not free: it touches a cell at a corner that the whole does
  /// not.
  bool add_leg(const Vector2& to, int parts) {
    const std::size_t before = route_.size();
    const Vector2 from = route_.back();
    for (int k = 1; k <= parts; ++k) {
      const Vector2 point = k < parts ? Vector2(from + (to - from) * k / parts) : to;
      const auto cost = leg_cost(map_, ground_, route_.back(), point);
      if (!cost && parts > 1) {
        route_.resize(before);
        cost_.resize(before);
        return false;
      }
      cost_.push_back(cost_.back() + cost.value_or(0.0));
      route_.push_back(point);
    }
    return true;
  }
  bool is_better(std::size_t from, std::size_t to) const {
    const auto cost = leg_cost(map_, ground_, route_[from], route_[to]);
    return cost && *cost <= (cost_[to] - cost_[from]) * kSlack;
  }
  /// Doubles the way until it is no good, then halves.
  std::size_t farthest_from(std::size_t at) const {
    const std::size_t last = route_.size() - 1;
    std::size_t good = at + 1, step = 2;
    while (good < last && is_better(at, std::min(at + step, last))) {
      good = std::min(at + step, last);
      step *= 2;
    }
    std::size_t bad = std::min(at + step, last + 1);
    while (bad - good > 1) {
      const std::size_t middle = good + (bad - good) / 2;
      (is_better(at, middle) ? good : bad) = middle;
    }
    return good;
  }

  const Costmap& map_;
  const Ground& ground_;
  std::vector<Vector2> route_;
  std::vector<double> cost_;  ///< from the first point
};

}  // namespace

std::vector<Vector2> pulled(std::vector<Vector2> route_map, const Costmap& map, const Ground& ground) {
  for (int round = 0; round < kRounds; ++round) {
    // Another spacing each time: the points fall elsewhere.
    const double spacing_m = (kCoarseSide + round % 3) * map.cell_size_m();
    route_map = Shortener(route_map, spacing_m, map, ground).run();
    std::reverse(route_map.begin(), route_map.end());
  }
  return route_map;
}

}  // namespace dynslam
