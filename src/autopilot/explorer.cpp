// SPDX-License-Identifier: MIT
#include "autopilot/explorer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid/ray_walk.h"

namespace dynslam {
namespace {

/// Two places so near to each other are one.
constexpr double kSamePlace_m = 0.6;
/// So long a frontier must be gone to have been seen.
constexpr Duration kGone = std::chrono::milliseconds(600);
/// An aim that had a way has one again by then, or whoever is in it stays.
constexpr Duration kHold = std::chrono::seconds(4);
constexpr Duration kSure = std::chrono::seconds(5);
/// Who stands in the only way out has gone on by then.
constexpr Duration kWayFree = std::chrono::seconds(20);
constexpr double kSeenFrom_m = 0.8;
/// There is ground so near to what is to be seen.
constexpr double kBeside_m = 0.4;
/// So far from a door it is out of the way, so long at a time.
constexpr double kAside_m = 1.2, kFarAside_m = 1.8;
constexpr Duration kTakesTurns = std::chrono::seconds(12);
/// Routes are looked for within so far of the robot first.
constexpr double kLooksFirst_m = 12.0;

/// Through a closed door, or a wall, nothing is seen.
bool is_in_sight(const GridSnapshot& map, const Vector2& from, const Vector2& to) {
  bool is_clear = true;
  walk_ray(from, to, map.cell_size_m(),
           [&](CellIndex c) { is_clear = is_clear && map.state(c) != CellState::kOccupied; });
  return is_clear;
}

}  // namespace

void Explorer::observe(Time now, const GridSnapshot& map, const PoseEstimate& pose) {
  map_ = map;
  frontier_map_.update(now, map);
  if (!pose.lost) visits_.note(now, pose.map_T_robot.translation());
}

void Explorer::begin() {
  aim_.reset();
  places_.clear();
  chosen_at_.reset();
  door_.reset();
  before_door_since_.reset();
  seems_over_since_.reset();
  judged_at_.reset();
  hope_left_ = looks_left_ = from_seconds(config_.door_patience_s);
  over_ = false;
  seemed_over_ = last_look_ = false;
}

bool Explorer::choose(Time now, const Vector2& robot_map, const Costmap& costmap, PathPlanner& planner) {
  if (!aim_ || !is_seen(*aim_)) {
    aim_seen_since_.reset();
  } else if (!aim_seen_since_ || now < *aim_seen_since_) {
    aim_seen_since_ = now;
  }
  if (aim_seen_since_) {
    if (now - *aim_seen_since_ < kGone) return false;
    exploration_.vanished(now, *aim_);
    aim_.reset();
    aim_seen_since_.reset();
    chosen_at_.reset();
  }
  if (chosen_at_ && now >= *chosen_at_ && now < *chosen_at_ + from_seconds(config_.choose_every_s))
    return false;
  chosen_at_ = now;
  find_places(now, robot_map, costmap, planner);
  if (holds_aim(now)) return false;
  if (has_frontier()) {
    before_door_since_.reset();
  } else {
    wait_well(now, robot_map);
  }
  if (places_.empty()) {
    aim_.reset();
    return false;
  }
  const Place& best = places_.front();
  if (aim_ && (aim_->stand_map - best.stand_map).norm() < kSamePlace_m) return false;
  aim_ = best;
  aim_had_way_at_ = now;
  return true;
}

/// Whoever walks through a door hides all that lies behind it for a moment: to turn round for that, and round
/// again, takes longer than to wait.
bool Explorer::holds_aim(Time now) {
  if (!aim_ || aim_->kind != PlaceKind::kFrontier) return false;
  const auto is_aim = [&](const Place& p) {
    return p.kind == PlaceKind::kFrontier && (aim_->is_shut_off || !p.is_shut_off) &&
           (p.point_map - aim_->point_map).norm() < kSamePlace_m + 0.5 * p.gain;
  };
  const bool has_way = std::any_of(places_.begin(), places_.end(), is_aim);
  if (has_way || now < aim_had_way_at_) aim_had_way_at_ = now;
  return !has_way && now - aim_had_way_at_ < kHold;
}

/// What a frontier hid is often seen long before the robot is there.
bool Explorer::is_seen(const Place& place) const {
  if (place.kind != PlaceKind::kFrontier) return false;
  const std::vector<Frontier> frontiers = frontier_map_.frontiers(last_look_);
  return std::none_of(frontiers.begin(), frontiers.end(), [&](const Frontier& f) {
    return (f.middle_map - place.point_map).norm() < kSamePlace_m + 0.5 * f.extent_m;
  });
}

void Explorer::find_places(Time now, const Vector2& robot_map, const Costmap& costmap, PathPlanner& planner) {
  double looked_m = kLooksFirst_m;
  const RouteLengths& lengths = planner.reach(costmap, robot_map, looked_m);
  const auto look_farther = [&] {
    if (std::isinf(looked_m)) return false;
    looked_m *= 2.0;
    if (planner.reach_farther(looked_m).is_whole()) looked_m = std::numeric_limits<double>::infinity();
    return true;
  };
  const Reachability reach{[&](const Vector2& point) { return lengths.length_m(point); },
                           [&](const Vector2& point, double within_m) {
                             const auto stand = lengths.nearest_reached(point, within_m);
                             return stand && is_in_sight(map_, *stand, point) ? stand : std::nullopt;
                           },
                           [&](const Vector2& point) {
                             return std::isinf(looked_m) ? lengths.before_what_shuts(point, kBeside_m)
                                                         : std::nullopt;
                           },
                           [&] { return looked_m; },
                           look_farther,
                           [&](const Vector2& point) { return lengths.leads_by_post(point); }};
  std::vector<Frontier> frontiers = frontier_map_.frontiers(last_look_);
  for (Frontier& f : frontiers) f.beyond_m2 = frontier_map_.beyond_m2(f);
  places_ = exploration_.places(now, robot_map, frontiers, visits_, map_, reach, seemed_over_);
  door_.reset();
  if (std::isinf(looked_m)) find_door(frontiers, lengths);
  judge(now);
}

void Explorer::find_door(const std::vector<Frontier>& frontiers, const RouteLengths& lengths) {
  for (const Frontier& f : frontiers) {
    if (f.extent_m < kDoor_m || exploration_.was_looked_at(f.middle_map)) continue;
    if (f.is_rest || exploration_.is_nook(f) || lengths.nearest_reached(f.middle_map, kSeenFrom_m)) continue;
    const auto before_it = lengths.before_what_shuts(f.middle_map, kBeside_m);
    if (!before_it) continue;
    const double route_m = lengths.length_m(*before_it).value_or(0.0);
    if (!door_ || route_m < door_->route_m) door_ = Place{PlaceKind::kOld, f.middle_map, *before_it, route_m};
  }
  if (door_) aside_map_ = lengths.reached_away_from(door_->stand_map, kAside_m, kFarAside_m);
}

/// Where nothing new can be reached: before a door that was shut, until that is given up; else it stands
/// still to make sure, unless it goes on for ever. Before the door it sees best whether that opens, and is in
/// the way: it takes turns.
void Explorer::wait_well(Time now, const Vector2& robot_map) {
  if (!door_ || over_) {
    if (!goes_on()) places_.clear();
    return;
  }
  Place wait = *door_;
  if (!before_door_since_ || now < *before_door_since_) before_door_since_ = now;
  const bool makes_room = (now - *before_door_since_) / kTakesTurns % 2 == 1;
  if (makes_room && aside_map_) wait.stand_map = *aside_map_;
  const bool is_there = (wait.stand_map - robot_map).norm() < kSamePlace_m;
  if (!is_there && !makes_room) before_door_since_ = now;
  places_ = {wait};
  if (is_there) places_.clear();
}

/// It is over when for some time there was nothing to go to for the first time. Whoever stands in a doorway
/// goes on soon; for doors that are shut it hopes longer. Both that, and driving to doors for the first time,
/// is bounded all in all: gaps that it does not fit into look the same, and there may be no end of them.
void Explorer::judge(Time now) {
  const Duration since_last =
      judged_at_ && *judged_at_ <= now ? std::min(now - *judged_at_, kSure) : Duration(0);
  judged_at_ = now;
  const bool is_shut_off = has_frontier() && places_.front().is_shut_off;
  const bool looks = is_shut_off && places_.front().tries == 0 && looks_left_ > Duration(0);
  if (looks) looks_left_ -= since_last;
  const bool hopes = has_frontier() || waits_for_door() || exploration_.left_out().next;
  if (looks || (has_frontier() && !is_shut_off)) {
    seems_over_since_.reset();
    if (places_.front().gain >= kDoor_m) last_look_ = false;
  } else if (!seems_over_since_ || now < *seems_over_since_) {
    seems_over_since_ = now;
    seemed_over_ = last_look_ = true;
  } else if (hopes) {
    hope_left_ -= since_last;
  }
  const Duration patience = exploration_.left_out().cut_off > 0 ? kWayFree : kSure;
  over_ = seems_over_since_ && now - *seems_over_since_ >= patience && !(hopes && hope_left_ > Duration(0));
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
