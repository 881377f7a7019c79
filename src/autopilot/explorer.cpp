// SPDX-License-Identifier: MIT
#include "autopilot/explorer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dynslam {
namespace {

/// Two places so near to each other are one.
constexpr double kSamePlace_m = 0.6;
constexpr Duration kSure = std::chrono::seconds(5);
constexpr double kSeenFrom_m = 0.8;
constexpr std::size_t kMostRemembered = 1000;
/// Routes are looked for within so far of the robot first; a map with longer ones than the second is looked
/// at whole.
constexpr double kLooksFirst_m = 12.0, kLooksAll_m = 100.0;

bool is_near_any(const std::deque<Vector2>& points, const Vector2& point) {
  return std::any_of(points.begin(), points.end(),
                     [&](const Vector2& p) { return (p - point).norm() < kSamePlace_m; });
}

}  // namespace

void Explorer::observe(Time now, const GridSnapshot& map, const PoseEstimate& pose) {
  map_ = map;
  frontier_map_.update(map);
  if (!pose.lost) visits_.note(now, pose.map_T_robot.translation());
}

void Explorer::begin() {
  aim_.reset();
  places_.clear();
  chosen_at_.reset();
  once_reachable_.clear();
  waits_for_door_ = false;
  seems_over_since_.reset();
  over_ = false;
}

bool Explorer::choose(Time now, const Vector2& robot_map, const Costmap& costmap, PathPlanner& planner) {
  if (aim_ && is_seen(*aim_)) {
    exploration_.vanished(now, *aim_);
    aim_.reset();
    chosen_at_.reset();
  }
  if (chosen_at_ && now >= *chosen_at_ && now < *chosen_at_ + from_seconds(config_.choose_every_s))
    return false;
  chosen_at_ = now;
  find_places(now, robot_map, costmap, planner);
  // Who does not go on for ever stands still to make sure, unless a door has to be looked at.
  if (!goes_on() && !waits_for_door_)
    std::erase_if(places_, [](const Place& p) { return p.kind != PlaceKind::kFrontier; });
  if (places_.empty()) {
    aim_.reset();
    return false;
  }
  const Place& best = places_.front();
  if (aim_ && (aim_->stand_map - best.stand_map).norm() < kSamePlace_m) return false;
  aim_ = best;
  return true;
}

/// What a frontier hid is often seen long before the robot is there.
bool Explorer::is_seen(const Place& place) const {
  if (place.kind != PlaceKind::kFrontier) return false;
  const std::vector<Frontier> frontiers = frontier_map_.frontiers();
  return std::none_of(frontiers.begin(), frontiers.end(), [&](const Frontier& f) {
    return (f.middle_map - place.point_map).norm() < kSamePlace_m + 0.5 * f.extent_m;
  });
}

void Explorer::find_places(Time now, const Vector2& robot_map, const Costmap& costmap, PathPlanner& planner) {
  double looked_m = kLooksFirst_m;
  const RouteLengths* lengths = &planner.reach(costmap, robot_map, looked_m);
  const auto look_farther = [&] {
    if (std::isinf(looked_m)) return false;
    looked_m = looked_m < kLooksAll_m ? 4.0 * looked_m : std::numeric_limits<double>::infinity();
    lengths = &planner.reach(costmap, robot_map, looked_m);
    return true;
  };
  const Reachability reach{
      [&](const Vector2& point) { return lengths->length_m(point); },
      [&](const Vector2& point, double within_m) { return lengths->nearest_reached(point, within_m); },
      [&] { return looked_m; }, look_farther};
  const std::vector<Frontier> frontiers = frontier_map_.frontiers();
  // A door is seen to be open again by who passes by.
  places_ = exploration_.places(now, robot_map, frontiers, visits_, map_, reach, waits_for_door_);
  remember_reachable();
  const auto has_lost_its_way = [&](const Frontier& f) {
    return !reach.nearest(f.middle_map, kSeenFrom_m) && is_near_any(once_reachable_, f.middle_map);
  };
  waits_for_door_ = std::isinf(looked_m) && std::any_of(frontiers.begin(), frontiers.end(), has_lost_its_way);
  judge(now);
}

void Explorer::remember_reachable() {
  for (const Place& place : places_) {
    if (place.kind != PlaceKind::kFrontier) return;
    if (!is_near_any(once_reachable_, place.point_map)) once_reachable_.push_back(place.point_map);
    if (once_reachable_.size() > kMostRemembered) once_reachable_.pop_front();
  }
}

/// It is over when for some time there was nothing to go to for the first time. Whoever stands in a doorway
/// goes on soon; a door that was shut behind the robot is waited for longer.
void Explorer::judge(Time now) {
  const bool has_frontier = !places_.empty() && places_.front().kind == PlaceKind::kFrontier;
  if (has_frontier || exploration_.left_out().next) {
    seems_over_since_.reset();
  } else if (!seems_over_since_ || now < *seems_over_since_) {
    seems_over_since_ = now;
  }
  const Duration patience = waits_for_door_ ? from_seconds(config_.door_patience_s) : kSure;
  over_ = seems_over_since_ && now - *seems_over_since_ >= patience;
}

void Explorer::reached(Time now) {
  exploration_.reached(now, *aim_);
  aim_.reset();
  chosen_at_.reset();
}

void Explorer::failed(Time now) {
  exploration_.failed(now, *aim_);
  aim_.reset();
  chosen_at_.reset();
}

}  // namespace dynslam
