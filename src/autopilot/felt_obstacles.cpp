// SPDX-License-Identifier: MIT
#include "autopilot/felt_obstacles.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr Duration kRemembers = std::chrono::minutes(10);
constexpr std::size_t kMost = 64;
constexpr double kRadius_m = 0.08;
/// Touched again it is larger than was thought, and each time by this.
constexpr double kGrows_m = 0.15, kMostRadius_m = 0.4;
constexpr int kCorners = 8;
/// A pallet is a metre wide.
constexpr double kOneThing_m = 1.0;
/// Towards a corner of the robot.
constexpr double kAside_rad = 0.7;

std::vector<Vector2> outline_around(const Vector2& middle, double radius_m) {
  std::vector<Vector2> outline;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = kTwoPi * i / kCorners;
    outline.emplace_back(middle + radius_m * Vector2(std::cos(angle), std::sin(angle)));
  }
  return outline;
}

bool is_one_thing(const Vector2& a, const Vector2& b) { return (a - b).norm() <= kOneThing_m; }

/// Of one of the places where something was touched.
double radius_among(const std::vector<Vector2>& places_map, const Vector2& place_map) {
  const auto touches = std::count_if(places_map.begin(), places_map.end(),
                                     [&](const Vector2& p) { return is_one_thing(p, place_map); });
  return std::min(kRadius_m + kGrows_m * static_cast<double>(touches - 1), kMostRadius_m);
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
  std::vector<Vector2> places_map;
  for (const Felt& f : felt_)
    if (f.counts()) places_map.push_back(f.guesses_map[f.guess]);
  std::vector<std::vector<Vector2>> outlines;
  for (auto place = places_map.begin(); place != places_map.end(); ++place) {
    outlines.push_back(outline_around(*place, radius_among(places_map, *place)));
    for (auto other = places_map.begin(); other != place; ++other)
      if (is_one_thing(*other, *place) && *other != *place)
        outlines.push_back(outline_between(*other, *place));
  }
  return outlines;
}

}  // namespace dynslam
