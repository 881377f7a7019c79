// SPDX-License-Identifier: MIT
#include "errand_scripts.h"

#include <algorithm>
#include <cmath>

#include "goal_rules.h"

namespace dynslam {
namespace {

constexpr double kReached_m = 0.05;
constexpr double kReached_rad = 5.0 * kTwoPi / 360.0;
/// A place with less floor around it may be too tight to stand at with some room to spare.
constexpr double kRoomy_m = 0.2;
/// The pose of a robot that stands is known after a scan or two.
constexpr Duration kSettle = std::chrono::milliseconds(600);
constexpr std::chrono::minutes kMostForOne{4};

std::vector<Vector2> floor_map(Simulator& simulator) {
  const Pose2 map_T_world = simulator.world().world_T_start.inverse();
  std::vector<Vector2> floor = simulator.reachable_floor(kFloorStep_m);
  for (Vector2& p : floor) p = map_T_world * p;
  return floor;
}

std::size_t floor_within(const std::vector<Vector2>& floor, const Vector2& point, double within_m) {
  return static_cast<std::size_t>(std::count_if(
      floor.begin(), floor.end(), [&](const Vector2& p) { return (p - point).norm() < within_m; }));
}

bool is_on(const std::vector<Vector2>& floor, const Vector2& point) {
  return floor_within(floor, point, 0.75 * kFloorStep_m) > 0;
}

/// Whether there is floor all around it.
bool is_roomy(const std::vector<Vector2>& floor, const Vector2& point) {
  constexpr int kProbes = 12;
  for (int i = 0; i < kProbes; ++i) {
    const double angle = kTwoPi * i / kProbes;
    if (!is_on(floor, point + kRoomy_m * Vector2(std::cos(angle), std::sin(angle)))) return false;
  }
  return true;
}

}  // namespace

void Errand::ask(Ports& ports, const Order& order) {
  ports.orders.push(order);
  ++asked_;
}

std::shared_ptr<const AutopilotStatus> Errand::ended(const Ports& ports) const {
  auto status = ports.autopilot.get().value;
  if (!status || status->errand < asked_ || status->phase == AutopilotPhase::kActive) return nullptr;
  return status;
}

std::optional<MissionEnd> ExploreScript::turn(Time, Ports& ports, Simulator&) {
  if (!asked_) errand_.ask(ports, Explore{});
  asked_ = true;
  const auto status = errand_.ended(ports);
  if (!status) return std::nullopt;
  return MissionEnd{status->phase == AutopilotPhase::kIdle ? "done" : "stopped", status->reason};
}

void DoorsByLot::turn(Time now, Simulator& simulator) {
  const auto& doors = simulator.world().doors;
  for (std::size_t i = 0; i < doors.size() && !begun_; ++i) {
    const double open = doors[i].schedule.empty() ? doors[i].open : doors[i].schedule.back().open;
    if (open > 0.0) doors_.push_back({i, open, false, now + from_seconds(random_.uniform(0.0, 200.0))});
  }
  begun_ = true;
  for (Door& door : doors_) {
    if (now < door.moves_at) continue;
    door.closed = !door.closed;
    simulator.move_door(door.index, door.closed ? 0.0 : door.open);
    const double lasts_s = door.closed ? random_.uniform(10.0, 40.0) : random_.uniform(100.0, 300.0);
    door.moves_at = now + from_seconds(lasts_s);
  }
}

bool Helper::turn(Time now, Ports& ports) {
  constexpr double kSlow_mps = 0.15;
  constexpr Duration kFor = std::chrono::milliseconds(1500);
  const auto drive = ports.drive.get().value;
  const bool touches = drive && drive->collision.value_or(false);
  if (!since_) {
    if (!touches || gave_up()) return false;
    since_ = now;
  } else if (now - *since_ > kFor) {
    since_.reset();
    tries_ = touches ? tries_ + 1 : 0;
  }
  const auto last = ports.command.get().value;
  const double speed_mps = !since_ ? 0.0 : tries_ % 2 == 0 ? -kSlow_mps : kSlow_mps;
  ports.command.put({(last ? last->seq : 0) + 1, {speed_mps, 0.0}, now, !since_});
  return since_.has_value();
}

std::optional<MissionEnd> GoalsScript::turn(Time now, Ports& ports, Simulator& simulator) {
  if (!explored_) {
    explored_ = exploration_.turn(now, ports, simulator);
    if (!explored_) return std::nullopt;
    explored_at_s_ = seconds_of(now);
    errand_ = exploration_.errand();
  }
  if (explored_->result != "done") return explored_;
  doors_.turn(now, simulator);
  if (goal_) {
    const auto status = errand_.ended(ports);
    if (!status && now - goal_->since < kMostForOne) return std::nullopt;
    if (!ended_at_) ended_at_ = now;
    if (now - *ended_at_ < kSettle) return std::nullopt;
    if (status) {
      judge(ports, simulator, *status);
    } else {
      fail("it takes for ever");
    }
    goal_.reset();
    ended_at_.reset();
  }
  if (helper_.turn(now, ports)) return std::nullopt;
  if (helper_.gave_up()) return MissionEnd{"stopped", "what it touched holds it"};
  if (counts_.tried >= wanted_) {
    const std::string all = std::to_string(counts_.tried - counts_.failed) + " of " + std::to_string(wanted_);
    return MissionEnd{"done", all + " goals reached, or rightly not"};
  }
  ask(now, ports, simulator);
  return std::nullopt;
}

void GoalsScript::ask(Time now, Ports& ports, Simulator& simulator) {
  std::vector<Vector2> floor = floor_map(simulator);
  const Destination to = draw(floor);
  goal_ = Goal{to, std::move(floor), now};
  ++counts_.tried;
  errand_.ask(ports, GoThere{to});
}

Destination GoalsScript::draw(const std::vector<Vector2>& floor) {
  Destination to;
  if (random_.uniform() < 0.9 && !floor.empty()) {
    const auto at = static_cast<std::size_t>(random_.uniform() * static_cast<double>(floor.size()));
    const double off_m = 0.5 * kFloorStep_m;
    to.point_map = floor[at] + Vector2{random_.uniform(-off_m, off_m), random_.uniform(-off_m, off_m)};
  } else {
    Vector2 low = Vector2::Zero(), high = Vector2::Zero();
    for (const Vector2& p : floor) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    to.point_map = {random_.uniform(low.x() - 1.0, high.x() + 1.0),
                    random_.uniform(low.y() - 1.0, high.y() + 1.0)};
  }
  if (random_.uniform() < 0.5) to.yaw_rad = random_.uniform(-kTwoPi / 2, kTwoPi / 2);
  return to;
}

void GoalsScript::judge(const Ports& ports, Simulator& simulator, const AutopilotStatus& status) {
  if (status.phase == AutopilotPhase::kIdle) return judge_place(ports, simulator, status);
  if (!status.reason.starts_with("no route")) return fail(status.reason);
  // A door may have closed, or opened, since.
  const bool was_free = is_on(goal_->floor_map, goal_->to.point_map);
  const bool is_free = is_on(floor_map(simulator), goal_->to.point_map);
  const bool has_room = is_roomy(goal_->floor_map, goal_->to.point_map);
  if (was_free && is_free && has_room) return fail(status.reason);
  ++counts_.no_route_right;
}

/// By its own map, as people see it; how far that is from the truth is reported.
void GoalsScript::judge_place(const Ports& ports, Simulator& simulator, const AutopilotStatus& status) {
  const auto world = ports.world.get().value;
  const Pose2& pose = world->pose.map_T_robot;
  const double off_m = (pose.translation() - goal_->to.point_map).norm();
  if (!is_roomy(goal_->floor_map, goal_->to.point_map) && off_m > kReached_m) {
    if (off_m > kNearby_m) return fail(status.reason + ", but " + std::to_string(off_m) + " m from it");
    ++counts_.reached;
    return;
  }
  const double off_rad = goal_->to.yaw_rad ? std::abs(dynslam::turn(*goal_->to.yaw_rad, pose.yaw)) : 0.0;
  if (off_m > kReached_m || off_rad > kReached_rad)
    return fail(status.reason + ", but " + std::to_string(off_m) + " m and " + std::to_string(off_rad) +
                " rad off");
  const Pose2 truth_map = simulator.world().world_T_start.inverse() * simulator.truth().world_T_robot;
  worst_true_m_ = std::max(worst_true_m_, (truth_map.translation() - goal_->to.point_map).norm());
  worst_m_ = std::max(worst_m_, off_m);
  worst_rad_ = std::max(worst_rad_, off_rad);
  ++counts_.reached;
}

void GoalsScript::fail(const std::string& why) {
  ++counts_.failed;
  failures_.push_back({{"goal", counts_.tried},
                       {"asked_at_s", seconds_of(goal_->since)},
                       {"x_m", goal_->to.point_map.x()},
                       {"y_m", goal_->to.point_map.y()},
                       {"reason", why}});
}

nlohmann::json GoalsScript::details() const {
  return {{"explored_at_s", explored_at_s_},
          {"failures", failures_},
          {"worst_m", worst_m_},
          {"worst_rad", worst_rad_},
          {"worst_true_m", worst_true_m_}};
}

}  // namespace dynslam
