// SPDX-License-Identifier: MIT
#include "drive/walker_watch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/angles.h"

namespace dynslam {
namespace {

constexpr double kFar_m = 1.6;
/// Of one leg the points follow on each other within so much, and it is no wider than this.
constexpr double kGap_m = 0.04, kGapShare = 0.02, kWidest_m = 0.25;
constexpr int kLeastPoints = 3;
/// What is beside it lies so much behind it, or so far round.
constexpr double kBehind_m = 0.05, kBeside_rad = 0.1;
/// From one scan to the next a leg swings no farther.
constexpr double kSwing_m = 0.25;
/// It has stepped when it moved so far in so long, and by a share of what the robot moved more: how far that
/// was is a guess.
constexpr double kStepped_m = 0.2, kGuess = 0.5;
constexpr Duration kStepsWithin = std::chrono::milliseconds(800);
constexpr Duration kForgets = std::chrono::milliseconds(1500);
constexpr double kHiddenWithin_m = 0.08;  ///< and the blind zone
/// A patch of glass moves as the lidar does along it, or lags behind by so much.
constexpr double kLag = 0.3, kLag_m = 0.03;
constexpr int kRingPoints = 16;
constexpr std::size_t kMostLegs = 64;

/// Points that follow on each other, seen from the lidar.
struct Thing {
  Vector2 first, last, low, high, sum = Vector2::Zero();
  int points = 0;

  Vector2 middle() const { return sum / points; }
  void add(const Vector2& p) {
    if (points == 0) first = low = high = p;
    last = p;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    sum += p;
    ++points;
  }
};

std::vector<Thing> things_of(std::span<const ObstaclePoint> points, const Pose2& lidar_T_robot) {
  std::vector<Thing> things;
  for (const ObstaclePoint& point : points) {
    const Vector2 p = lidar_T_robot * Vector2(point.x_m, point.y_m);
    const bool goes_on = !things.empty() && (p - things.back().last).norm() < kGap_m + kGapShare * p.norm();
    if (!goes_on) things.emplace_back();
    things.back().add(p);
  }
  return things;
}

/// Whether the end of a thing is its own, and not hidden by what is beside it.
bool is_whole(const Vector2& end, const Vector2& beside) {
  const double turned_rad =
      std::abs(std::atan2(end.x() * beside.y() - end.y() * beside.x(), end.dot(beside)));
  return turned_rad > kBeside_rad || beside.norm() > end.norm() + kBehind_m;
}

/// The middles of what may be legs.
std::vector<Vector2> legs_among(const std::vector<Thing>& things) {
  std::vector<Vector2> legs;
  const std::size_t n = things.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Thing& thing = things[i];
    if (thing.points < kLeastPoints || (thing.high - thing.low).norm() > kWidest_m) continue;
    if (thing.middle().norm() > kFar_m) continue;
    const bool stands_before = is_whole(thing.first, things[(i + n - 1) % n].last) &&
                               is_whole(thing.last, things[(i + 1) % n].first);
    if (n == 1 || stands_before) legs.push_back(thing.middle());
  }
  return legs;
}

}  // namespace

void WalkerWatch::see(std::span<const ObstaclePoint> points, const Look& look) {
  end_ = look.end;
  lidar_ = look.robot_T_lidar.translation();
  carry(look);
  for (const Vector2& leg : legs_among(things_of(points, look.robot_T_lidar.inverse())))
    follow(look.robot_T_lidar * leg, look.end);
  std::erase_if(legs_, [&](const Leg& leg) { return leg.seen != end_ && is_gone(leg, look); });
}

/// As the robot moved.
void WalkerWatch::carry(const Look& look) {
  if (!look.before_T_now) return legs_.clear();
  const Pose2 now_T_before = look.before_T_now->inverse();
  for (Leg& leg : legs_)
    for (Vector2* p : {&leg.at, &leg.from, &leg.lidar_from}) *p = now_T_before * *p;
}

/// Behind the other leg, or too near to be seen, it is there still.
bool WalkerWatch::is_gone(const Leg& leg, const Look& look) const {
  const Vector2 from_lidar = look.robot_T_lidar.inverse() * leg.at;
  const double range_m = from_lidar.norm();
  if (look.sight.farthest_m(Sight::sector_of(from_lidar)) > range_m + kSwing_m) return true;
  return end_ - leg.seen > (range_m < blind_m_ + kHiddenWithin_m ? kStands : kForgets);
}

void WalkerWatch::follow(const Vector2& at, Time now) {
  Leg* nearest = nullptr;
  double least_m = kSwing_m;
  for (Leg& leg : legs_) {
    const double distance_m = (leg.at - at).norm();
    if (leg.seen == now || distance_m >= least_m) continue;
    nearest = &leg;
    least_m = distance_m;
  }
  if (!nearest) {
    if (legs_.size() < kMostLegs) legs_.push_back({at, now, at, lidar_, now, {}});
    return;
  }
  Leg& leg = *nearest;
  leg.at = at;
  leg.seen = now;
  const bool steps = has_stepped(leg);
  if (steps) leg.stepped = now;
  if (steps || now - leg.from_at > kStepsWithin) {
    leg.from = at;
    leg.lidar_from = lidar_;
    leg.from_at = now;
  }
}

/// And not as a patch of glass wanders.
bool WalkerWatch::has_stepped(const Leg& leg) const {
  const Vector2 towards = (leg.at - lidar_).normalized();
  const Vector2 moved = lidar_ - leg.lidar_from;
  if ((leg.at - leg.from).norm() < kStepped_m + kGuess * moved.norm()) return false;
  const Vector2 along = moved - towards * towards.dot(moved);
  return (leg.at - leg.from - along).norm() > kLag * along.norm() + kLag_m;
}

void WalkerWatch::add_to(std::vector<ObstaclePoint>& points, const BodyConfig& body) const {
  for (const Leg& leg : legs_) {
    if (!leg.stepped || end_ - *leg.stepped > kStands) continue;
    for (int i = 0; i < kRingPoints; ++i) {
      const double angle = i * kTwoPi / kRingPoints;
      const Vector2 p = leg.at + kStep_m * Vector2(std::cos(angle), std::sin(angle));
      if (!body.contains(p)) points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y())});
    }
  }
}

}  // namespace dynslam
