// SPDX-License-Identifier: MIT
#include "autopilot/exploration.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace dynslam {
namespace {

/// Whether a door has opened is looked at when all else is done.
constexpr double kShutOffCost_m = 1000.0;
/// What is left of a frontier after a look from near is hardly worth another unless it is as wide as this.
constexpr double kWide_m = 1.0;
/// As far as the unknown is looked at, so much of it may be a room, or a hall.
constexpr double kRoom_m2 = 8.0;
/// So many history cells are told of: the first of them is what matters.
constexpr std::size_t kMostCells = 16;

std::optional<double> route_to(const Vector2& point_map, const Reachability& reach) {
  const std::optional<double> route_m = reach.route_m(point_map);
  return route_m && std::isfinite(*route_m) ? route_m : std::nullopt;
}

/// The least rectangle of history cells that holds the map; both ends inside.
struct HistoryBox {
  CellIndex low, high;

  explicit HistoryBox(const GridSnapshot& map)
      : low(cell_at(cell_centre(first_cell(map.box().min), map.cell_size_m()), kHistoryCell_m)),
        high(cell_at(cell_centre(last_cell(map.box()), map.cell_size_m()), kHistoryCell_m)) {}
  static CellIndex last_cell(const ChunkBox& box) {
    const CellIndex beyond = first_cell({box.max.x + 1, box.max.y + 1});
    return {beyond.x - 1, beyond.y - 1};
  }
  bool contains(CellIndex c) const { return c.x >= low.x && c.x <= high.x && c.y >= low.y && c.y <= high.y; }
  /// How many rings there are around a cell in it.
  int rings(CellIndex c) const { return std::max({c.x - low.x, high.x - c.x, c.y - low.y, high.y - c.y}); }
  /// The cells in the box that lie `ring` cells away, diagonals counting as one.
  template <class Visit>
  void for_each_on_ring(CellIndex middle, int ring, Visit&& visit) const {
    const int left = middle.x - ring, right = middle.x + ring;
    for (int y = std::max(low.y, middle.y - ring); y <= std::min(high.y, middle.y + ring); ++y) {
      const bool is_whole_row = std::abs(y - middle.y) == ring;
      if (!is_whole_row && left >= low.x) visit(CellIndex{left, y});
      if (!is_whole_row && right <= high.x) visit(CellIndex{right, y});
      if (!is_whole_row) continue;
      for (int x = std::max(low.x, left); x <= std::min(high.x, right); ++x) visit(CellIndex{x, y});
    }
  }
};

}  // namespace

std::vector<Place> Exploration::places(Time now, const Vector2& robot_map,
                                       std::span<const Frontier> frontiers, const VisitMap& visits,
                                       const GridSnapshot& map, const Reachability& reach, bool once) {
  left_out_ = {};
  once_ = once;
  std::vector<Ranked> found;
  if (robot_map.allFinite()) {
    found = frontier_places(now, frontiers, reach);
    if (found.empty()) found = unvisited_places(now, robot_map, visits, map, reach);
    if (found.empty()) found = old_places(now, visits, reach);
  }
  stay_with_chosen(found);
  const auto order = [](const Ranked& r) {
    return std::make_tuple(r.rank, r.place.point_map.x(), r.place.point_map.y());
  };
  std::sort(found.begin(), found.end(),
            [&](const Ranked& a, const Ranked& b) { return order(a) < order(b); });
  std::vector<Place> places;
  places.reserve(found.size());
  for (const Ranked& r : found) places.push_back(r.place);
  if (!places.empty()) chosen_ = places.front();
  return places;
}

/// Looks only as far as needed: farther away none can be better than the best.
std::vector<Exploration::Ranked> Exploration::frontier_places(Time now, std::span<const Frontier> frontiers,
                                                              const Reachability& reach) {
  const double most_gain_m = config_.gain_weight * config_.most_extent_m + config_.keep_m;
  see(now, frontiers);
  std::vector<Ranked> found;
  const auto is_sure = [&](const Ranked& r) { return r.rank + most_gain_m <= reach.looked_m(); };
  do {
    found = frontiers_reached(now, frontiers, reach);
  } while (std::none_of(found.begin(), found.end(), is_sure) && reach.look_farther());
  return found;
}

std::vector<Exploration::Ranked> Exploration::frontiers_reached(Time now, std::span<const Frontier> frontiers,
                                                                const Reachability& reach) {
  left_out_ = {};
  std::vector<Ranked> found;
  for (const Frontier& f : frontiers) {
    if (!f.middle_map.allFinite() || !counts(now, f.middle_map)) continue;
    std::optional<Vector2> stand_map = reach.nearest(f.middle_map, config_.stand_within_m);
    const bool is_shut_off = !stand_map, is_small = is_nook(f);
    if (is_small && is_shut_off) continue;
    if (stand_map && f.extent_m < kDoor_m && reach.is_risky(*stand_map)) continue;
    if (is_left_alone(now, f, is_shut_off)) continue;
    if (is_shut_off) ++left_out_.out_of_reach;
    if (is_shut_off && f.extent_m >= kDoor_m && !was_looked_at(f.middle_map)) {
      stand_map = reach.before_door(f.middle_map);
      if (!stand_map) ++left_out_.cut_off;
    }
    const std::optional<double> route_m = stand_map ? route_to(*stand_map, reach) : std::nullopt;
    if (!route_m || *route_m > worth_m(f)) continue;
    const TriedPlaces::Tried* tried = frontiers_.find(f.middle_map);
    const int tries = tried ? tried->tries : 0;
    const double later_m = (is_shut_off ? kShutOffCost_m : 0.0) + config_.retry_cost_m * tries;
    // What is shut off from so near lies behind a leg of furniture, or a door that was waited for already.
    const bool is_near = (*stand_map - f.middle_map).norm() <= config_.stand_within_m;
    const bool may_open = is_shut_off && !(once_ && is_near);
    found.push_back(
        {*route_m - config_.gain_weight * f.extent_m + later_m,
         {PlaceKind::kFrontier, f.middle_map, *stand_map, *route_m, f.extent_m, may_open, tries}});
  }
  return found;
}

/// So long a way it is worth, by what there is to be seen.
double Exploration::worth_m(const Frontier& f) const {
  if (is_nook(f)) return config_.nook_way_m;
  if (f.beyond_m2 >= kRoom_m2) return std::numeric_limits<double>::infinity();
  return config_.nook_way_m * f.beyond_m2 / config_.nook_m2;
}

/// A frontier is one of before when it is near to where that was. Those of the first time were always there.
/// Of what was chosen the rest is worth it too.
void Exploration::see(Time now, std::span<const Frontier> frontiers) {
  std::vector<Seen> seen;
  seen.reserve(frontiers.size());
  for (const Frontier& f : frontiers) {
    const double near_m = config_.same_place_m + 0.5 * f.extent_m;
    Time since = seen_.empty() ? Time::min() : now;
    for (const Seen& s : seen_)
      if ((s.middle_map - f.middle_map).norm() <= near_m) since = std::min(since, s.since);
    const bool is_chosen = chosen_ && chosen_->kind == PlaceKind::kFrontier &&
                           (chosen_->point_map - f.middle_map).norm() <= near_m;
    seen.push_back({f.middle_map, since, is_chosen || !f.is_rest});
  }
  seen_ = std::move(seen);
}

bool Exploration::counts(Time now, const Vector2& middle_map) const {
  const auto seen =
      std::find_if(seen_.begin(), seen_.end(), [&](const Seen& s) { return s.middle_map == middle_map; });
  return seen != seen_.end() && seen->is_worth_it &&
         (seen->since == Time::min() || now - seen->since >= from_seconds(config_.steady_s));
}

/// A door that opened again is not left alone.
bool Exploration::is_left_alone(Time now, const Frontier& frontier, bool is_shut_off) {
  const TriedPlaces::Tried* tried = frontiers_.find(frontier.middle_map);
  if (!tried) return false;
  const bool is_once_enough = tried->last_try == InVain::kSeen && (once_ || frontier.extent_m < kWide_m);
  if (tried->tries >= (is_once_enough ? 1 : config_.most_tries)) {
    ++left_out_.given_up;
    return true;
  }
  if (tried->until <= now || (tried->last_try == InVain::kShut && !is_shut_off)) return false;
  ++left_out_.waiting;
  const bool is_waited_for = tried->last_try != InVain::kSeen && (!once_ || frontier.extent_m >= kDoor_m);
  if (is_waited_for) left_out_.next = std::min(left_out_.next.value_or(tried->until), tried->until);
  return true;
}

/// Ring by ring around the robot, until no cell farther out can be nearer by its route.
std::vector<Exploration::Ranked> Exploration::unvisited_places(Time now, const Vector2& robot_map,
                                                               const VisitMap& visits,
                                                               const GridSnapshot& map,
                                                               const Reachability& reach) const {
  std::vector<Ranked> found;
  const HistoryBox box(map);
  if (map.box().empty() || robot_map.cwiseAbs().maxCoeff() >= kWorld_m) return found;
  const CellIndex here = cell_at(robot_map, kHistoryCell_m);
  if (!box.contains(here)) return found;
  const auto look_at = [&](CellIndex cell) {
    const Vector2 centre = cell_centre(cell, kHistoryCell_m);
    if (map.state(cell_at(centre, map.cell_size_m())) != CellState::kFree || visits.last_visit(cell)) return;
    const std::optional<double> route_m = route_to(centre, reach);
    if (!route_m) return;
    const TriedPlaces::Tried* tried = cells_.find(centre);
    if (tried && tried->until > now) return;
    found.push_back({*route_m, {PlaceKind::kUnvisited, centre, centre, *route_m, 0.0}});
  };
  for (int ring = 0; ring <= box.rings(here); ++ring) {
    const double least_m = (ring - 0.5) * kHistoryCell_m;
    const auto nearer = std::count_if(found.begin(), found.end(),
                                      [&](const Ranked& r) { return r.place.route_m <= least_m; });
    if (static_cast<std::size_t>(nearer) >= kMostCells) break;
    box.for_each_on_ring(here, ring, look_at);
  }
  return found;
}

/// A cell counts as reached in the circle that fits into it.
std::vector<Exploration::Ranked> Exploration::old_places(Time now, const VisitMap& visits,
                                                         const Reachability& reach) const {
  std::vector<Ranked> found;
  for (const auto& [visit, cell] : visits.by_age()) {
    if (now - visit < from_seconds(config_.revisit_after_s) || found.size() >= kMostCells) break;
    const Vector2 centre = cell_centre(cell, kHistoryCell_m);
    const TriedPlaces::Tried* tried = cells_.find(centre);
    if (tried && tried->until > now) continue;
    const std::optional<Vector2> stand_map = reach.nearest(centre, 0.5 * kHistoryCell_m);
    const std::optional<double> route_m = stand_map ? route_to(*stand_map, reach) : std::nullopt;
    if (!route_m) continue;
    found.push_back(
        {static_cast<double>(found.size()), {PlaceKind::kOld, centre, *stand_map, *route_m, 0.0}});
  }
  return found;
}

/// The middle of a frontier moves while part of it is seen: what is nearest to where it was is the same one.
void Exploration::stay_with_chosen(std::vector<Ranked>& found) const {
  if (!chosen_ || chosen_->kind == PlaceKind::kOld) return;
  Ranked* nearest = nullptr;
  double least_m = 0.5 * config_.most_extent_m;
  for (Ranked& r : found) {
    const double distance_m = (r.place.point_map - chosen_->point_map).norm();
    if (r.place.kind != chosen_->kind || distance_m >= least_m) continue;
    least_m = distance_m;
    nearest = &r;
  }
  if (nearest) nearest->rank -= config_.keep_m;
}

/// Cells are never given up: an old one that somebody stands in today is one to see in half an hour.
void Exploration::failed(Time now, const Place& place) {
  if (!place.point_map.allFinite()) return;
  chosen_.reset();
  const Duration retry = from_seconds(config_.retry_after_s);
  if (place.kind == PlaceKind::kFrontier) {
    frontiers_.add(now, place.point_map, retry);
  } else if (cells_.add(now, place.point_map, retry) >= config_.most_tries) {
    cells_.rest(now, place.point_map, from_seconds(config_.revisit_after_s));
  }
}

bool Exploration::was_looked_at(const Vector2& frontier_map) const {
  const TriedPlaces::Tried* tried = frontiers_.find(frontier_map);
  return tried && tried->tries > 0 && tried->last_try == InVain::kSeen;
}

/// A frontier that comes back where it was is one of those that flicker at the edge of what can be seen.
void Exploration::vanished(Time now, const Place& place) {
  chosen_.reset();
  if (place.kind == PlaceKind::kFrontier && place.point_map.allFinite())
    frontiers_.add(now, place.point_map, Duration(0), InVain::kSeen);
}

void Exploration::reached(Time now, const Place& place) {
  if (place.kind == PlaceKind::kUnvisited) return failed(now, place);
  chosen_.reset();
  if (!place.point_map.allFinite()) return;
  const Duration retry = from_seconds(config_.retry_after_s);
  if (place.kind == PlaceKind::kOld) return cells_.rest(now, place.point_map, retry);
  frontiers_.add(now, place.point_map, retry, place.is_shut_off ? InVain::kShut : InVain::kSeen);
}

}  // namespace dynslam
