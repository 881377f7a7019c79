// SPDX-License-Identifier: MIT
#include "autopilot/felt_obstacles.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr Duration kRemembers = std::chrono::minutes(10);
constexpr std::size_t kMost = 64;
constexpr double kRadius_m = 0.08;
constexpr int kCorners = 8;
/// A pallet is a metre wide.
constexpr double kOneThing_m = 1.0;
/// Towards a corner of the robot.
constexpr double kAside_rad = 0.7;

std::vector<Vector2> outline_around(const Vector2& middle) {
  std::vector<Vector2> outline;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = kTwoPi * i / kCorners;
    outline.emplace_back(middle + kRadius_m * Vector2(std::cos(angle), std::sin(angle)));
  }
  return outline;
}

/// What joins two such outlines.
std::vector<Vector2> outline_between(const Vector2& a, const Vector2& b) {
  const Vector2 along = (b - a).normalized(), aside = kRadius_m * Vector2(-along.y(), along.x());
  return {a - aside, b - aside, b + aside, a + aside};
}

}  // namespace

void FeltObstacles::touched(Time now, const Pose2& map_T_robot, const Twist& driven, double robot_radius_m) {
  Felt felt{now, {}};
  if (driven.v_mps != 0.0) {
    const double ahead_m = std::copysign(robot_radius_m + 0.5 * kRadius_m, driven.v_mps);
    for (const double aside_rad : {0.0, kAside_rad, -kAside_rad})
      felt.guesses_map.push_back(map_T_robot * (ahead_m * Vector2(std::cos(aside_rad), std::sin(aside_rad))));
  }
  felt_.push_back(std::move(felt));
  if (felt_.size() > kMost) felt_.pop_front();
}

bool FeltObstacles::forget(Time now) {
  const auto is_over = [&](const Felt& f) { return now < f.time || now - f.time > kRemembers; };
  const std::size_t before = felt_.size();
  felt_.erase(std::remove_if(felt_.begin(), felt_.end(), is_over), felt_.end());
  return felt_.size() != before;
}

bool FeltObstacles::doubt() {
  const auto last = std::find_if(felt_.rbegin(), felt_.rend(), [](const Felt& f) { return f.counts(); });
  if (last == felt_.rend()) return false;
  ++last->guess;
  return true;
}

bool FeltObstacles::trust() {
  bool changes = false;
  for (Felt& f : felt_) {
    if (f.counts() || f.guesses_map.empty()) continue;
    f.guess = 0;
    changes = true;
  }
  return changes;
}

std::size_t FeltObstacles::count_since(Time since) const {
  return static_cast<std::size_t>(
      std::count_if(felt_.begin(), felt_.end(), [&](const Felt& f) { return f.time >= since; }));
}

std::vector<std::vector<Vector2>> FeltObstacles::outlines_map() const {
  std::vector<std::vector<Vector2>> outlines;
  std::vector<Vector2> places_map;
  for (const Felt& f : felt_) {
    if (!f.counts()) continue;
    const Vector2& place = f.guesses_map[f.guess];
    outlines.push_back(outline_around(place));
    for (const Vector2& other : places_map) {
      const double apart_m = (other - place).norm();
      if (apart_m > 0 && apart_m <= kOneThing_m) outlines.push_back(outline_between(other, place));
    }
    places_map.push_back(place);
  }
  return outlines;
}

}  // namespace dynslam
