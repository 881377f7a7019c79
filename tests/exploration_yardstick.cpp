// SPDX-License-Identifier: MIT
#include "exploration_yardstick.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "drive/body_config.h"
#include "plan/path_planner.h"
#include "true_floor.h"

namespace dynslam {
namespace {

constexpr double kLookEvery_m = 0.25;
/// Where it cannot stand on a frontier, it looks from so near.
constexpr double kStandWithin_m = 0.8;
constexpr double kFirstReach_m = 4.0, kLongestReach_m = 500.0;

World at_rest(World world) {
  world.people.clear();
  world.faults.clear();
  world.kicks.clear();
  for (Door& door : world.doors) {
    for (const DoorMove& move : door.schedule) door.open = std::max(door.open, move.open);
    door.schedule.clear();
  }
  for (Furniture& thing : world.furniture) thing.moves.clear();
  return world;
}

class Explorer {
 public:
  Explorer(const World& world, double range_m, const FollowerConfig& follower)
      : floor_(world), range_m_(range_m), follower_(follower), pose_(world.world_T_start) {
    floor_.look(pose_.translation(), range_m_);
  }

  Yardstick explore() {
    while (const auto target = nearest()) drive_to(*target);
    result_.seen = floor_.seen_share();
    return result_;
  }

 private:
  struct Target {
    std::size_t cell = 0;
    Vector2 stand;
  };

  std::optional<Target> nearest() {
    std::vector<std::size_t> cells = floor_.frontier();
    std::erase_if(cells, [&](std::size_t cell) { return tried_.contains(cell); });
    if (cells.empty()) return std::nullopt;
    for (double most_m = kFirstReach_m;; most_m *= 2) {
      const RouteLengths& lengths = planner_.reach(floor_.costmap(), pose_.translation(), most_m);
      if (const auto target = nearest_of(cells, lengths, 0.0)) return target;
      if (most_m > kLongestReach_m) return nearest_of(cells, lengths, kStandWithin_m);
    }
  }

  std::optional<Target> nearest_of(const std::vector<std::size_t>& cells, const RouteLengths& lengths,
                                   double stand_within_m) const {
    std::optional<Target> nearest;
    double least_m = std::numeric_limits<double>::infinity();
    for (const std::size_t cell : cells) {
      Vector2 stand = floor_.middle(cell);
      if (stand_within_m > 0) stand = lengths.nearest_reached(stand, stand_within_m).value_or(stand);
      const double length_m = lengths.length_m(stand).value_or(least_m);
      if (length_m >= least_m) continue;
      least_m = length_m;
      nearest = {cell, stand};
    }
    return nearest;
  }

  /// As long as there is something to see; what did not come into sight from there is not tried again.
  void drive_to(const Target& target) {
    const Plan plan = planner_.plan(floor_.costmap(), {pose_.translation(), target.stand});
    ++result_.routes;
    for (std::size_t i = 1; i < plan.route_map.size(); ++i) {
      if (!drive_leg(plan.route_map[i], target.cell)) return;
    }
    tried_.insert(target.cell);
  }

  /// Returns whether there is still something to see.
  bool drive_leg(const Vector2& to, std::size_t cell) {
    while (true) {
      const Vector2 way = to - pose_.translation();
      const double left_m = way.norm();
      if (left_m < 1e-6) return true;
      turn_to(std::atan2(way.y(), way.x()));
      const double step_m = std::min(kLookEvery_m, left_m);
      const Vector2 at = pose_.translation() + step_m / left_m * way;
      pose_ = {at.x(), at.y(), pose_.yaw};
      result_.way_m += step_m;
      result_.time_s += step_m / follower_.speed_mps;
      floor_.look(at, range_m_);
      if (!floor_.is_frontier(cell)) return false;
    }
  }

  void turn_to(double yaw) {
    result_.time_s += std::abs(turn(pose_.yaw, yaw)) / follower_.turn_radps;
    pose_.yaw = yaw;
  }

  TrueFloor floor_;
  double range_m_;
  FollowerConfig follower_;
  Pose2 pose_;
  PathPlanner planner_{PlannerConfig{}, BodyConfig{}.radius_m()};
  std::set<std::size_t> tried_;
  Yardstick result_;
};

}  // namespace

Yardstick exploration_yardstick(World world, double trusted_range_m, const FollowerConfig& follower) {
  return Explorer(at_rest(std::move(world)), trusted_range_m, follower).explore();
}

}  // namespace dynslam
