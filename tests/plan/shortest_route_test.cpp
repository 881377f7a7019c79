// SPDX-License-Identifier: MIT
// The planner's routes against the shortest there are, in small worlds of posts.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "plan/drawn_floor.h"

namespace dynslam {
namespace {

constexpr double kSide_m = 4;

DrawnFloor random_posts(std::mt19937& random) {
  DrawnFloor floor;
  floor.occupy(-0.1, -0.1, kSide_m + 0.1, kSide_m + 0.1);
  floor.clear(0, 0, kSide_m, kSide_m);
  std::uniform_real_distribution<double> at(0.1, kSide_m - 0.6), side(0.02, 0.7);
  for (int i = 0; i < 9; ++i) {
    const double x = at(random), y = at(random);
    const double width = side(random), height = side(random);
    floor.occupy(x, y, std::min(kSide_m, x + width), std::min(kSide_m, y + height));
  }
  return floor;
}

/// Exact any-angle distances by brute force: a visibility graph over all cells at the edge of where the robot
/// may be, searched by Dijkstra.
class VisibilityGraph {
 public:
  VisibilityGraph(const Costmap& map, double least_m) : map_(map), least_m_(least_m) {
    const int side = static_cast<int>(kSide_m / kCell_m);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (is_corner({x, y})) nodes_.push_back(cell_centre({x, y}, kCell_m));
      }
    }
  }

  double shortest_m(const Vector2& start, const Vector2& goal) const {
    std::vector<Vector2> nodes = nodes_;
    nodes.push_back(goal);
    std::vector<double> length(nodes.size(), std::numeric_limits<double>::infinity());
    std::vector<bool> done(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (sees(start, nodes[i])) length[i] = (nodes[i] - start).norm();
    }
    while (true) {
      std::size_t at = nodes.size();
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!done[i] && length[i] < least) least = length[at = i];
      }
      if (at >= nodes.size() - 1) return length.back();
      done[at] = true;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double there = length[at] + (nodes[i] - nodes[at]).norm();
        if (!done[i] && there < length[i] && sees(nodes[at], nodes[i])) length[i] = there;
      }
    }
  }

 private:
  bool is_free(CellIndex c) const { return map_.clearance_m(cell_centre(c, kCell_m)) >= least_m_; }
  /// Free, beside what is not, and with more that is free than not around it: a taut string bends only there.
  bool is_corner(CellIndex c) const {
    if (!is_free(c)) return false;
    const bool inside = is_free({c.x + 1, c.y}) && is_free({c.x - 1, c.y}) && is_free({c.x, c.y + 1}) &&
                        is_free({c.x, c.y - 1}) && is_free({c.x + 1, c.y + 1}) &&
                        is_free({c.x - 1, c.y - 1}) && is_free({c.x + 1, c.y - 1}) &&
                        is_free({c.x - 1, c.y + 1});
    int free = 0;
    for (int dy = -3; dy <= 3; ++dy) {
      for (int dx = -3; dx <= 3; ++dx) free += is_free({c.x + dx, c.y + dy});
    }
    return !inside && free >= 25;
  }
  /// As the clearance changes by no more than one moves, what it exceeds the least by can be skipped.
  bool sees(const Vector2& a, const Vector2& b) const {
    const double length_m = (b - a).norm();
    for (double at_m = 0; at_m < length_m;) {
      const double spare_m = map_.clearance_m(a + (b - a) * (at_m / length_m)) - least_m_;
      if (spare_m < 0) return false;
      at_m += std::max(0.5 * kCell_m, spare_m - 2 * kCell_m);
    }
    return map_.clearance_m(b) >= least_m_;
  }

  const Costmap& map_;
  double least_m_;
  std::vector<Vector2> nodes_;
};

TEST(ShortestRoute, IsMissedByLessThanTwoPerCent) {
  PlannerConfig config;
  config.comfort_weight = 0;
  config.post_weight = 1;
  PathPlanner planner(config, kRadius_m);
  double worst = 0;
  int routes = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    std::mt19937 random(seed);
    DrawnFloor floor = random_posts(random);
    const Costmap map = floor.costmap();
    const VisibilityGraph graph(map, kRadius_m + config.margin_m + 0.002);
    std::uniform_real_distribution<double> at(0.25, kSide_m - 0.25);
    for (int i = 0; i < 8; ++i) {
      const Vector2 start{at(random), at(random)}, goal{at(random), at(random)};
      if (map.clearance_m(start) < 0.24 || map.clearance_m(goal) < 0.24) continue;
      const double exact_m = graph.shortest_m(start, goal);
      const Plan plan = planner.plan(map, {start, goal});
      ASSERT_EQ(plan.outcome == PlanOutcome::kFound, std::isfinite(exact_m)) << seed << ": " << plan.reason;
      if (!std::isfinite(exact_m)) continue;
      worst = std::max(worst, plan.length_m / exact_m);
      EXPECT_LT(plan.length_m, 1.02 * exact_m) << "seed " << seed << ", " << i;
      EXPECT_GE(least_clearance_m(map, plan.route_map), kRadius_m + config.prune_margin_m);
      EXPECT_FALSE(planner.first_blocked_leg(map, plan.route_map)) << "seed " << seed << ", " << i;
      ++routes;
    }
  }
  EXPECT_GT(routes, 9);
  RecordProperty("worst", std::to_string(worst));
}

/// The comfortable way costs no more than the shortest would: what is saved is never paid for in room.
TEST(ShortestRoute, IsLeftForRoomOnlyWhenThatIsWorthIt) {
  PlannerConfig shortest;
  shortest.comfort_weight = 0;
  shortest.post_weight = 1;
  PathPlanner comfortable({}, kRadius_m), short_cut(shortest, kRadius_m);
  const Ground ground(PlannerConfig(), kRadius_m + 0.02, Unknown::kForbidden);
  const auto cost_of = [&](const Costmap& map, const std::vector<Vector2>& route) {
    double cost = 0;
    for (std::size_t i = 0; i + 1 < route.size(); ++i)
      cost += leg_cost(map, ground, route[i], route[i + 1]).value();
    return cost;
  };
  int routes = 0;
  for (unsigned seed = 100; seed < 120; ++seed) {
    std::mt19937 random(seed);
    DrawnFloor floor = random_posts(random);
    const Costmap map = floor.costmap();
    const PlanRequest request{{0.4, 0.4}, {3.6, 3.6}};
    const Plan a = comfortable.plan(map, request), b = short_cut.plan(map, request);
    if (a.outcome != PlanOutcome::kFound || map.clearance_m(request.start_map) < 0.24) continue;
    ++routes;
    EXPECT_LE(cost_of(map, a.route_map), 1.03 * cost_of(map, b.route_map)) << seed;
    EXPECT_GE(a.length_m, 0.99 * b.length_m) << seed;
    EXPECT_GE(least_clearance_m(map, a.route_map), kRadius_m + 0.02) << seed;
    EXPECT_FALSE(comfortable.first_blocked_leg(map, a.route_map)) << seed;
  }
  EXPECT_GT(routes, 5);
}

}  // namespace
}  // namespace dynslam
