// SPDX-License-Identifier: MIT
#include "sim/life.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "sim/robot_shape.h"

namespace dynslam {
namespace {

constexpr std::uint64_t kActorSteps = 5;  // people and doors move every 10 ms

double by_255ths(double power) { return std::round(std::clamp(power, -1.0, 1.0) * 255.0) / 255.0; }

}  // namespace

Life::Life(const World& world, Time begin, std::uint64_t seed)
    : begin_(begin),
      now_(begin),
      actors_(world),
      caster_(fixed_surfaces(world), Actors::reach(world)),
      body_(world, seed),
      blocked_([this](const Pose2& p) { return is_blocked(p); }),
      lidar_(begin, seed),
      imu_(begin, seed),
      last_view_(begin),
      heard_(begin - kFailsafe) {
  recent_.fill(body_.pose());
  caster_.set_moving(actors_.surfaces());
  note_truth();
}

void Life::command(const WheelPower& power, Time heard) {
  wanted_ = {by_255ths(power.left), by_255ths(power.right)};
  heard_ = heard;
}

bool Life::is_blocked(const Pose2& world_T_robot) const {
  constexpr double kReach_m = 0.17;  // from the robot's middle to its corners
  return caster_.any_near(world_T_robot.translation(), kReach_m,
                          [&](const Surface& s) { return robot_touches(world_T_robot, s); });
}

/// A ray from within a part leaves it without having entered.
bool Life::is_in_something(const Vector2& p) const {
  SpaceRay ray;
  ray.from = p;
  std::vector<RayHit> hits;
  caster_.cast_through(ray, std::numeric_limits<double>::infinity(), hits);
  std::set<int> entered;
  return std::any_of(hits.begin(), hits.end(), [&](const RayHit& hit) {
    if (hit.surface->low_m >= kRobotHigh_m || hit.surface->high_m <= kRobotLow_m) return false;
    if (hit.enters) entered.insert(hit.surface->part);
    return !hit.enters && !entered.contains(hit.surface->part);
  });
}

Room Life::room() const {
  constexpr double kCorner_m = 0.17;
  const Pose2& pose = body_.pose().world_T_robot;
  Room room{kMostRoom_m, kMostRoom_m};
  caster_.any_near(pose.translation(), kMostRoom_m + kCorner_m, [&](const Surface& s) {
    double& least_m = actors_.is_of_person(s) ? room.to_people_m : room.to_things_m;
    least_m = std::min(least_m, distance_to_robot(pose, s));
    return false;
  });
  return room;
}

std::optional<Surface> Life::touched() const {
  const auto& pressed_to = body_.pressed_to();
  std::optional<Surface> touched;
  if (!pressed_to) return touched;
  caster_.any_near(pressed_to->translation(), kMostRoom_m, [&](const Surface& s) {
    if (robot_touches(*pressed_to, s)) touched = s;
    return touched.has_value();
  });
  return touched;
}

bool Life::is_within(const Vector2& p) const {
  return (p.array() >= caster_.low_corner().array()).all() &&
         (p.array() <= caster_.high_corner().array()).all();
}

bool Life::place(const Pose2& world_T_robot) {
  const Vector2 p = world_T_robot.translation();
  if (!is_within(p) || is_blocked(world_T_robot) || is_in_something(p)) return false;
  body_.place(world_T_robot);
  recent_.fill(body_.pose());
  return true;
}

/// Whichever way it faces.
bool Life::could_stand_at(const Vector2& p) const {
  constexpr int kWays = 4;
  if (!is_within(p)) return false;
  for (int i = 0; i < kWays; ++i) {
    if (!is_blocked({p.x(), p.y(), i * kPi / kWays})) return !is_in_something(p);
  }
  return false;
}

/// Step by step over the floor, in all four directions. Where the robot itself is wedged in, the floor begins
/// beside it; that is too near for the other side of a wall.
std::vector<Vector2> Life::reachable_floor(double step_m) const {
  using Place = std::pair<int, int>;
  const Vector2 start = body_.pose().world_T_robot.translation();
  std::set<Place> seen = {{0, 0}};
  std::deque<Place> open = {{0, 0}};
  std::vector<Vector2> floor;
  while (!open.empty()) {
    const auto [column, row] = open.front();
    open.pop_front();
    const Vector2 p = start + step_m * Vector2(column, row);
    const bool can_stand = could_stand_at(p);
    if (!can_stand && (p - start).norm() > 1.5 * step_m) continue;
    if (can_stand) floor.push_back(p);
    for (const Place& next :
         {Place(column + 1, row), Place(column - 1, row), Place(column, row + 1), Place(column, row - 1)}) {
      if (seen.insert(next).second) open.push_back(next);
    }
  }
  return floor;
}

void Life::move_actors() {
  if (steps_ % kActorSteps != 0) return;
  const Duration length = kActorSteps * kStep;
  if (actors_.step(to_seconds(now_ - begin_), to_seconds(length), body_.pose().world_T_robot)) {
    caster_.set_moving(actors_.surfaces());
  }
}

void Life::note_truth() {
  truth_.push_back({now_, body_.pose().world_T_robot});
  if (truth_.back().stamp - truth_.front().stamp > kTruthKept) truth_.pop_front();
}

void Life::step() {
  move_actors();
  body_.set_power(now_ - heard_ < kFailsafe ? wanted_ : WheelPower{});
  const BodyPose before = body_.pose();
  body_.step(to_seconds(kStep), blocked_);
  lidar_.step(kStep, before, body_.pose(), caster_, scans);
  now_ += kStep;
  ++steps_;
  recent_[steps_ % recent_.size()] = body_.pose();
  if ((now_ - begin_) % ImuModel::kPeriod == Duration::zero()) {
    constexpr auto kLagSteps = static_cast<std::uint64_t>(ImuModel::kLag / kStep);
    imu_.measure(now_, recent_[(steps_ + recent_.size() - kLagSteps) % recent_.size()], imu);
    note_truth();
  }
  if (now_ - last_view_ >= kViewPeriod) {
    views.put(now_, {now_, body_.pose(), caster_.moving()});
    last_view_ = now_;
  }
}

}  // namespace dynslam
