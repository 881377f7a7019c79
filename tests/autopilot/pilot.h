// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "autopilot/autopilot.h"
#include "autopilot/drawn_building.h"

namespace dynslam {

/// Two rooms and a door.
inline const std::vector<std::string> kFlat = {
    "##############################",  //
    "#.............#..............#",  //
    "#.............#..............#",  //
    "#.............#.......g......#",  //
    "#.............d..............#",  //
    "#..s..........d..............#",  //
    "#.............d..............#",  //
    "#.............#..............#",  //
    "#.............#..............#",  //
    "##############################",  //
};

/// An autopilot whose wishes are granted: the robot glides along its route.
struct Pilot {
  explicit Pilot(const std::vector<std::string>& lines, const AutopilotSetup& setup = {})
      : building(lines), autopilot(setup) {
    at.x = building.find('s').x();
    at.y = building.find('s').y();
  }

  DrawnBuilding building;
  Autopilot autopilot;
  Pose2 at;
  Time now = Time(std::chrono::seconds(50));
  std::vector<Order> orders;
  std::shared_ptr<MapNotes> notes;
  FollowReport follow;
  Condition condition;
  Twist came;
  bool steered = false, lost = false, looks = false, glides = true;
  double way_m = 0.0;

  AutopilotStatus turn(const Order& order) {
    orders.push_back(order);
    return turn();
  }

  AutopilotStatus turn() {
    now += std::chrono::milliseconds(200);
    if (looks) building.look(at.translation());
    auto world = std::make_shared<WorldState>(building.world(now, at));
    world->pose.lost = lost;
    condition.pose = world->pose;
    const AutopilotStatus status =
        autopilot.turn(now, {orders, world, notes, follow, condition, steered, came});
    orders.clear();
    glide();
    return status;
  }

  /// Ten centimetres a turn.
  void glide() {
    follow = {};
    const auto& task = autopilot.task();
    if (!task) return;
    follow.task = task->id;
    follow.state = Following::kDriving;
    const Vector2 here = at.translation();
    std::vector<Vector2> left;
    for (const Vector2& p : task->route_map)
      if ((p - here).norm() > 1e-6) left.push_back(p);
    // What was passed already: everything up to the leg that the robot stands on.
    for (std::size_t i = 1; i < task->route_map.size(); ++i) {
      const Vector2 a = task->route_map[i - 1], b = task->route_map[i];
      if (std::abs((here - a).norm() + (here - b).norm() - (b - a).norm()) < 1e-6)
        left.assign(task->route_map.begin() + static_cast<std::ptrdiff_t>(i), task->route_map.end());
    }
    double budget_m = glides ? 0.1 : 0.0;
    Vector2 p = here;
    while (!left.empty() && budget_m > 0.0) {
      const double leg_m = (left.front() - p).norm();
      const double step_m = std::min(leg_m, budget_m);
      if (leg_m > 0.0) p += step_m / leg_m * (left.front() - p);
      budget_m -= step_m;
      way_m += step_m;
      if (step_m >= leg_m) left.erase(left.begin());
    }
    at.x = p.x();
    at.y = p.y();
    follow.route_map = {p};
    follow.route_map.insert(follow.route_map.end(), left.begin(), left.end());
    for (std::size_t i = 1; i < follow.route_map.size(); ++i)
      follow.remaining_m += (follow.route_map[i] - follow.route_map[i - 1]).norm();
    if (left.empty()) follow.state = Following::kArrived;
  }

  /// As long as that, and it is at something.
  AutopilotStatus run_while(const std::function<bool()>& goes_on, int most_turns = 1000) {
    AutopilotStatus status = turn();
    while (status.phase == AutopilotPhase::kActive && goes_on() && --most_turns > 0) status = turn();
    EXPECT_GT(most_turns, 0) << "it never ends: " << status.reason;
    return status;
  }

  /// Until it drives no more.
  AutopilotStatus run(int most_turns = 3000) {
    return run_while([] { return true; }, most_turns);
  }
  double away_m(const Vector2& point) const { return (point - at.translation()).norm(); }
};

struct KnownFlat : Pilot {
  explicit KnownFlat(const AutopilotSetup& setup = {}) : Pilot(kFlat, setup) { building.know_all(); }
};

}  // namespace dynslam
