// SPDX-License-Identifier: MIT
#include "drive/glass_watch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "drive/line_fit.h"

namespace dynslam {
namespace {

constexpr double kFar_m = 2.2;
/// Points of one thing follow on each other within so much; glass returns some of the beams only.
constexpr double kGap_rad = 0.06, kGap_m = 0.08, kGapShare = 0.06;
constexpr std::size_t kLeastPoints = 6;
/// So straight it is, and by so much of the range more.
constexpr double kStraight_m = 0.012, kStraightShare = 0.006;
/// Of normal incidence: more aslant a beam goes through.
constexpr double kSquare_rad = 0.3, kNearlySquare_rad = 0.035;
/// So far beside the patch one sees through, and so far behind.
constexpr double kBeside_rad[] = {0.08, 0.14};
constexpr double kBehind_m = 0.25;
// When patches are of one thing,
constexpr double kSameLine_m = 0.05, kNext_m = 0.12, kKeeps_m = 0.5;
// and wander: so far the robot has moved along them, and so much they may lag behind.
constexpr double kMoved_m = 0.15, kSurelyMoved_m = 0.3, kLag = 0.3, kLag_m = 0.03;
/// What wandered so stays a pane while it lags behind by no more than this times as much, but not surely one.
constexpr double kStays = 2.0;
constexpr Duration kSureAfter = std::chrono::milliseconds(600), kLikelyAfter = std::chrono::milliseconds(300);
constexpr Duration kForgets = std::chrono::milliseconds(1500);
/// What was surely a pane, and what may have been somebody's leg.
constexpr Duration kForgetsHidden = std::chrono::seconds(30), kForgetsDoubtful = std::chrono::seconds(8);
/// So long it is where it was, as far as the robot knows how it moved.
constexpr Duration kJustHidden = std::chrono::seconds(1);
constexpr double kHiddenWithin_m = 0.08, kVanishesWithin_m = 0.03;  ///< and the blind zone
// What is added of a pane: about the robot, and beyond what was seen of it.
constexpr double kNear_m = 1.0, kAbout_m = 0.35, kBeyond_m = 0.3, kStep_m = 0.02;
/// The way out from where it cannot be seen is away from it, not along it.
constexpr double kBeyondHidden_m = 1.0;
/// Of what is as near as this only the beams come back that noise makes longer.
constexpr double kMayBeNearer_m = 0.015;
constexpr std::size_t kMostTracks = 64;

using Points = std::vector<Vector2>;

/// Things that stand apart, as one looks round.
std::vector<Points> things_of(std::span<const ObstaclePoint> points, const Pose2& lidar_T_robot) {
  std::vector<Points> things;
  Vector2 last = Vector2::Zero();
  for (const ObstaclePoint& point : points) {
    const Vector2 p = lidar_T_robot * Vector2(point.x_m, point.y_m);
    const double range_m = p.norm();
    if (range_m > kFar_m) continue;
    const double turned_rad = std::abs(std::atan2(last.x() * p.y() - last.y() * p.x(), last.dot(p)));
    const bool goes_on =
        !things.empty() && turned_rad < kGap_rad && (p - last).norm() < kGap_m + kGapShare * range_m;
    if (!goes_on) things.emplace_back();
    things.back().push_back(p);
    last = p;
  }
  return things;
}

/// Where one looks squarely at a thing, and past it on both sides.
std::optional<Segment> patch_of(const Points& thing, const Sight& sight) {
  if (thing.size() < kLeastPoints) return std::nullopt;
  const Line line = line_through(thing);
  const Vector2 foot = line.through - line.along * line.along.dot(line.through);
  const double away_m = foot.norm();
  if (away_m < 0.05 || line.across_m > kStraight_m + kStraightShare * away_m) return std::nullopt;
  double low = 1e9, high = -1e9;
  for (const Vector2& p : thing) {
    low = std::min(low, line.along.dot(p));
    high = std::max(high, line.along.dot(p));
  }
  const double from_rad = std::atan2(low, away_m), to_rad = std::atan2(high, away_m);
  if (from_rad < -kSquare_rad || to_rad > kSquare_rad) return std::nullopt;
  if (from_rad > kNearlySquare_rad || to_rad < -kNearlySquare_rad) return std::nullopt;
  for (const double beside : kBeside_rad) {
    for (const double at : {from_rad - beside, to_rad + beside}) {
      const Vector2 there = foot + line.along * (away_m * std::tan(at));
      const double sees_m = sight.farthest_m(Sight::sector_of(there));
      if (sees_m > 0.0 && sees_m < there.norm() + kBehind_m) return std::nullopt;
    }
  }
  return Segment{foot + low * line.along, foot + high * line.along};
}

Vector2 middle_of(const Segment& s) { return 0.5 * (s.from + s.to); }

}  // namespace

void GlassWatch::see(std::span<const ObstaclePoint> points, const Look& look) {
  end_ = look.end;
  lidar_ = look.robot_T_lidar.translation();
  if (!look.before_T_now) tracks_.clear();
  const Pose2 now_T_before = look.before_T_now.value_or(Pose2{}).inverse();
  std::erase_if(tracks_, [&](Track& t) {
    for (Vector2* p : {&t.all.from, &t.all.to, &t.patch.from, &t.patch.to, &t.first, &t.lidar_first})
      *p = now_T_before * *p;
    return look.end - t.seen > kept_for(t);
  });
  for (const Points& thing : things_of(points, look.robot_T_lidar.inverse()))
    if (const auto patch = patch_of(thing, look.sight))
      follow({look.robot_T_lidar * patch->from, look.robot_T_lidar * patch->to}, look.end);
}

void GlassWatch::follow(const Segment& patch, Time now) {
  if (patch.length_m() < 0.01) return;
  for (Track& t : tracks_) {
    const auto both = joined(t.all, patch, kSameLine_m, kNext_m);
    if (!both) continue;
    // What was long ago is no longer where the robot's motion is thought to have carried it.
    const Span now_at = span_along(*both, patch);
    t.all = on_line(
        *both, {std::max(0.0, now_at.low - kKeeps_m), std::min(both->length_m(), now_at.high + kKeeps_m)});
    t.patch = patch;
    t.seen = now;
    t.away_m = off_line_m(patch, lidar_);
    if (t.pane_since && !wanders_as_glass(t, kStays)) {
      t.pane_since.reset();
    } else if (!t.pane_since && std::abs(moved_along_m(t)) > kMoved_m && wanders_as_glass(t)) {
      t.pane_since = now;
    }
    return;
  }
  if (tracks_.size() >= kMostTracks) return;
  tracks_.push_back({patch, patch, now, off_line_m(patch, lidar_), middle_of(patch), lidar_, {}});
}

double GlassWatch::moved_along_m(const Track& t) const {
  return (t.all.to - t.all.from).dot(lidar_ - t.lidar_first) / t.all.length_m();
}

bool GlassWatch::wanders_as_glass(const Track& t, double tolerance) const {
  const Vector2 along = (t.all.to - t.all.from) / t.all.length_m();
  const double wandered_m = along.dot(middle_of(t.patch) - t.first);
  const double moved_m = moved_along_m(t);
  return std::abs(wandered_m - moved_m) < tolerance * (kLag * std::abs(moved_m) + kLag_m);
}

/// Somebody who walks beside the robot does not do so for long.
bool GlassWatch::was_glass_for(const Track& t, Duration least) {
  return t.pane_since && t.seen - *t.pane_since > least;
}

bool GlassWatch::is_surely_glass(const Track& t) const {
  return was_glass_for(t, kSureAfter) && std::abs(moved_along_m(t)) > kSurelyMoved_m && wanders_as_glass(t);
}

/// It came too near to be seen, and may go on for as long as it does.
bool GlassWatch::came_too_near(const Track& t) const {
  return t.away_m < blind_m_ + kVanishesWithin_m && was_glass_for(t, kLikelyAfter) && wanders_as_glass(t);
}

Duration GlassWatch::kept_for(const Track& t) const {
  if (off_line_m(t.patch, lidar_) >= blind_m_ + kHiddenWithin_m) return kForgets;
  if (is_surely_glass(t)) return kForgetsHidden;
  return came_too_near(t) || was_glass_for(t, kSureAfter) ? kForgetsDoubtful : kForgets;
}

void GlassWatch::add_to(std::vector<ObstaclePoint>& points, const BodyConfig& body) const {
  for (const Track& t : tracks_) {
    if (!t.pane_since || off_line_m(t.patch, lidar_) > kNear_m) continue;
    const double here = span_along(t.patch, {lidar_, lidar_}).low;
    const Span all = span_along(t.patch, t.all);
    const double beyond_m = came_too_near(t) ? kBeyondHidden_m : kBeyond_m;
    const double low = std::max(here - kAbout_m, all.low - beyond_m);
    const double high = std::min(here + kAbout_m, all.high + beyond_m);
    const Vector2 foot = on_line(t.patch, {here, here}).from;
    const Vector2 nearer = kMayBeNearer_m * (lidar_ - foot).normalized();
    for (double at = low; at <= high; at += kStep_m) {
      const Vector2 p = on_line(t.patch, {at, at}).from + nearer;
      if (!body.contains(p, BodyConfig::kMayBeSmaller_m))
        points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y())});
    }
  }
}

std::vector<Segment> GlassWatch::panes() const {
  std::vector<Segment> panes;
  for (const Track& t : tracks_) {
    if (t.seen == end_ && is_surely_glass(t)) {
      panes.push_back(t.all);
    } else if (end_ - t.seen < kJustHidden && came_too_near(t)) {
      panes.push_back(on_line(t.all, {-kBeyondHidden_m, t.all.length_m() + kBeyondHidden_m}));
    }
  }
  return panes;
}

}  // namespace dynslam
