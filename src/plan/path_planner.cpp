// SPDX-License-Identifier: MIT
#include "plan/path_planner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/ray_walk.h"
#include "plan/ground_there_was.h"
#include "plan/route_pull.h"
#include "plan/way_out.h"

namespace dynslam {
namespace {

/// Room of so few coarse cells is not somewhere to be: a square metre, as behind a door that stands open.
constexpr std::size_t kPocket = 150;
/// So far before a door that is shut its leaf can open: a metre is as wide as they are.
constexpr double kBefore_m = 1.2, kFarBefore_m = 1.6;
/// So many metres of way are worth a metre more, to the leaf or to the walls.
constexpr double kTooNear = 10.0;
/// All that is reached of the ground before one door is nearer to the place before it.
constexpr double kSameDoor_m = 1.2;

Plan no_route(std::string reason) {
  Plan plan;
  plan.reason = std::move(reason);
  return plan;
}

double length_of(const std::vector<Vector2>& route) {
  double length_m = 0;
  for (std::size_t i = 1; i < route.size(); ++i) length_m += (route[i] - route[i - 1]).norm();
  return length_m;
}

Vector2 best_point(const Costmap& costmap, std::size_t coarse) {
  return cell_centre(costmap.coarse().best_cell(coarse), costmap.cell_size_m());
}

/// The point of the map's box nearest to a finite one.
Vector2 into_box(const Costmap& costmap, const Vector2& point) {
  const CellIndex low = first_cell(costmap.box().min);
  const CellIndex high = first_cell({costmap.box().max.x + 1, costmap.box().max.y + 1});
  const auto centre = [&](CellIndex c) { return cell_centre(c, costmap.cell_size_m()); };
  return point.cwiseMax(centre(low)).cwiseMin(centre({high.x - 1, high.y - 1}));
}

/// Whether the robot may end just there; where not, why.
std::optional<std::string> trouble_at(const Costmap& costmap, const Ground& ground, const Vector2& point) {
  if (!costmap.contains(point)) return "outside of the map";
  const CellIndex c = cell_at(point, costmap.cell_size_m());
  const CoarseCell& coarse = costmap.coarse()[costmap.coarse().index_of(c)];
  if (costmap.is_forbidden(c)) return "forbidden area";
  if (costmap.is_occupied(c)) return "a wall stands there";
  if (ground.price(coarse, 255) == 0) return "unknown ground";
  if (ground.price(coarse, costmap.clearance_steps(c)) == 0) return "too near to a wall";
  return std::nullopt;
}

bool is_in_sight(const Costmap& costmap, const Vector2& from, const Vector2& to) {
  bool free = true;
  walk_ray(from, to, costmap.cell_size_m(), [&](CellIndex c) { free = free && !costmap.is_occupied(c); });
  return free;
}

/// The farthest point on the way from a free place to one that is not.
Vector2 as_far_as_free(const Costmap& costmap, const Ground& legs, const Vector2& from, const Vector2& to) {
  const double length_m = (to - from).norm();
  const int steps = static_cast<int>(length_m / costmap.cell_size_m());
  for (int i = steps; i > 0; --i) {
    Vector2 p = from + i * costmap.cell_size_m() / length_m * (to - from);
    if (costmap.contains(p) && leg_cost(costmap, legs, from, p)) return p;
  }
  return from;
}

}  // namespace

Plan PathPlanner::plan(const Costmap& costmap, const PlanRequest& request) {
  const Vector2 &start = request.start_map, &goal = request.goal_map;
  if (!start.allFinite() || !goal.allFinite()) return no_route("not a place");
  if (!costmap.contains(start)) return no_route("the robot is outside of the map");
  const Ground cells = this->cells(request.unknown), legs = this->legs(request.unknown);
  const auto out = into_the_open(costmap, cells, legs, start, goal);
  if (!out) return no_route("no way out from where the robot stands");

  const Found found = search(costmap, cells, legs, out->back(), goal);
  Plan plan;
  if (!found.exactly) {
    const auto trouble = trouble_at(costmap, cells, goal);
    plan.reason = found.gave_up ? "too far for the planner" : trouble.value_or("no way through");
  }
  if (!found.last) {
    plan.nearest_map = best_point(costmap, found.end);
    plan.is_cut_off = !found.gave_up && !trouble_at(costmap, cells, goal);
    if (const auto door = plan.is_cut_off ? what_shuts(costmap, request) : std::nullopt) {
      plan.door_map = best_point(costmap, *door);
      plan.sees_door = is_in_sight(costmap, start, *plan.door_map);
      plan.nearest_map = before(costmap, start, *door);
    }
    return plan;
  }
  plan.outcome = found.exactly ? PlanOutcome::kFound : PlanOutcome::kNearby;
  std::vector<Vector2> open = centres_to(costmap, found.end);
  open.insert(open.begin(), out->back());
  open.push_back(*found.last);
  plan.route_map.assign(out->begin(), out->end() - 1);
  for (const Vector2& p : pulled(std::move(open), costmap, legs)) plan.route_map.push_back(p);
  plan.length_m = length_of(plan.route_map);
  return plan;
}

/// From the start to where the robot has room. Room that nothing leads out of, as between the legs of a chair
/// that it got under, or in a passage so narrow that it has room only here and there, is left as well, unless
/// the goal is there.
std::optional<std::vector<Vector2>> PathPlanner::into_the_open(const Costmap& costmap, const Ground& cells,
                                                               const Ground& legs, const Vector2& start,
                                                               const std::optional<Vector2>& goal) {
  auto out = way_out(costmap, cells, start);
  if (!out) return out;
  const auto coarse = [&](const Vector2& p) {
    return costmap.coarse().index_of(cell_at(p, costmap.cell_size_m()));
  };
  std::vector<std::size_t> pockets;
  const auto leads_on = [&](std::size_t from) {
    if (std::find(pockets.begin(), pockets.end(), from) != pockets.end()) return false;
    const bool is_pocket = this->is_pocket(costmap, cells, legs, from, &pockets);
    return !is_pocket || (goal && costmap.contains(*goal) && search_.reached(coarse(*goal)));
  };
  if (leads_on(coarse(out->back()))) return out;
  const auto beyond = way_out_to(leads_on, costmap, cells, start);
  return beyond ? beyond : out;
}

/// Whether nothing leads out of the little room there is at that coarse cell; adds the cells to `pockets`.
bool PathPlanner::is_pocket(const Costmap& costmap, const Ground& cells, const Ground& legs, std::size_t from,
                            std::vector<std::size_t>* pockets) {
  search_.begin(costmap, cells, legs, from, std::nullopt);
  std::size_t size = 0;
  while (const auto settled = search_.next()) {
    if (++size > kPocket) return false;
    if (pockets) pockets->push_back(settled->index);
    search_.expand(*settled);
  }
  return true;
}

/// Where the goal has no room, the search goes on a little after it came near: the first place is not the
/// nearest.
PathPlanner::Found PathPlanner::search(const Costmap& costmap, const Ground& cells, const Ground& legs,
                                       const Vector2& from, const Vector2& goal) {
  const CoarseGrid& grid = costmap.coarse();
  const double cell_m = costmap.cell_size_m();
  const Vector2 aim_point = into_box(costmap, goal);
  const std::size_t first = grid.index_of(cell_at(from, cell_m));
  const std::size_t aim = grid.index_of(cell_at(aim_point, cell_m));
  const bool may_end = !trouble_at(costmap, cells, goal);
  const double dearest =
      1 + config_.comfort_weight;  // what is near to a goal that is too tight is tight itself
  const auto around = static_cast<std::uint32_t>(
      std::min(1e6, 8 * CoarseSearch::kStep * dearest * config_.goal_tolerance_m / (kCoarseSide * cell_m)));

  Found found{first, std::nullopt, false, false};
  double least_m = std::numeric_limits<double>::infinity();
  std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
  search_.begin(costmap, cells, legs, first, aim);
  int expansions = 0;
  while (const auto settled = search_.next()) {
    if (settled->estimate > most) break;
    const Vector2 centre = best_point(costmap, settled->index);
    const double distance_m = (centre - aim_point).norm();
    if (distance_m < least_m) {
      least_m = distance_m;
      found.end = settled->index;
    }
    if (may_end && settled->index == aim && leg_cost(costmap, legs, centre, goal))
      return {aim, goal, true, false};
    const bool is_near = (centre - goal).norm() <= config_.goal_tolerance_m;
    if (is_near && (!may_end || settled->index == aim)) most = std::min(most, settled->estimate + around);
    if ((found.gave_up = ++expansions > config_.most_expansions)) break;
    search_.expand(*settled);
  }
  const Vector2 nearest = best_point(costmap, found.end);
  if ((nearest - goal).norm() <= config_.goal_tolerance_m)
    found.last = as_far_as_free(costmap, legs, nearest, goal);
  return found;
}

/// The last coarse cell before it that can be reached.
std::optional<std::size_t> PathPlanner::what_shuts(const Costmap& costmap, const PlanRequest& request) const {
  const std::size_t aim = costmap.coarse().index_of(cell_at(request.goal_map, costmap.cell_size_m()));
  const auto is_reached = [&](std::size_t index) { return search_.reached(index); };
  const auto was_in_vain = [&](std::size_t index) {
    if (request.in_vain_map.empty() || !is_reached(index)) return false;
    const Vector2 at = best_point(costmap, index);
    return std::any_of(request.in_vain_map.begin(), request.in_vain_map.end(),
                       [&](const Vector2& place) { return (place - at).norm() < kSameDoor_m; });
  };
  return ground_there_was(costmap.coarse(), {&aim, 1}, cells(Unknown::kForbidden).least_clearance(),
                          is_reached, was_in_vain)
      .reached;
}

/// Of what the last search reached, the place nearest to the start from which it is seen whether the way is
/// free again, past a leaf that opened as well, and which leaves the leaf its room and has some itself; or
/// what comes nearest to that.
Vector2 PathPlanner::before(const Costmap& costmap, const Vector2& start, std::size_t door) const {
  const CoarseGrid& grid = costmap.coarse();
  const Vector2 door_map = best_point(costmap, door);
  const double coarse_m = kCoarseSide * costmap.cell_size_m();
  const int most = static_cast<int>(kFarBefore_m / coarse_m);
  Vector2 best = door_map;
  double least = std::numeric_limits<double>::infinity();
  for (int dy = -most; dy <= most; ++dy) {
    for (int dx = -most; dx <= most; ++dx) {
      const Vector2 near_it = door_map + coarse_m * Vector2(dx, dy);
      if (!costmap.contains(near_it)) continue;
      const std::size_t at = grid.index_of(cell_at(near_it, costmap.cell_size_m()));
      if (!search_.reached(at)) continue;
      const Vector2 place = best_point(costmap, at);
      const double from_door_m = (place - door_map).norm();
      const double lacking_m = std::max(0.0, kBefore_m - from_door_m) +
                               std::max(0.0, config_.comfort_m - costmap.clearance_m(place));
      const double cost = (place - start).norm() + kTooNear * lacking_m;
      if (from_door_m > kFarBefore_m || cost >= least || !is_in_sight(costmap, place, door_map)) continue;
      least = cost;
      best = place;
    }
  }
  return best;
}

/// The roomiest cells along the way that was found.
std::vector<Vector2> PathPlanner::centres_to(const Costmap& costmap, std::size_t end) const {
  std::vector<Vector2> centres{best_point(costmap, end)};
  for (std::size_t at = end; search_.before(at) != at;) {
    at = search_.before(at);
    centres.push_back(best_point(costmap, at));
  }
  std::reverse(centres.begin(), centres.end());
  return centres;
}

std::optional<std::size_t> PathPlanner::first_blocked_leg(const Costmap& costmap,
                                                          std::span<const Vector2> route_map) {
  if (route_map.size() < 2) return std::nullopt;
  if (!costmap.contains(route_map.front())) return 0;
  const Ground legs = this->legs(Unknown::kDear);
  const CellIndex first = cell_at(route_map.front(), costmap.cell_size_m());
  const double reach_m = way_out_reach_m(costmap, route_map.front());
  const bool leaves_forbidden = costmap.is_forbidden(first);
  const bool leaves_pocket = is_pocket(costmap, cells(Unknown::kForbidden), this->legs(Unknown::kForbidden),
                                       costmap.coarse().index_of(first), nullptr);
  bool on_way_out = true;
  const auto is_passable = [&](CellIndex c) {
    if (costmap.clearance_steps(c) >= legs.least_clearance()) {
      on_way_out = leaves_pocket;
      return true;
    }
    const Vector2 from_start = cell_centre(c, costmap.cell_size_m()) - route_map.front();
    return on_way_out && from_start.norm() <= reach_m && !costmap.is_occupied(c) &&
           (leaves_forbidden || !costmap.is_forbidden(c));
  };
  for (std::size_t i = 0; i + 1 < route_map.size(); ++i) {
    const Vector2 &from = route_map[i], &to = route_map[i + 1];
    if (!costmap.contains(from) || !costmap.contains(to)) return i;
    if (leg_cost(costmap, legs, from, to)) {
      on_way_out = leaves_pocket;
      continue;
    }
    bool free = on_way_out;
    walk_ray(from, to, costmap.cell_size_m(), [&](CellIndex c) { free = free && is_passable(c); });
    if (!free) return i;
  }
  return std::nullopt;
}

const RouteLengths& PathPlanner::reach(const Costmap& costmap, const Vector2& start_map, double most_m) {
  wave_cells_ = cells(Unknown::kForbidden);
  wave_legs_ = legs(Unknown::kForbidden);
  lengths_.reset(costmap, wave_cells_->least_clearance());
  if (!start_map.allFinite() || !costmap.contains(start_map)) return lengths_;
  const auto out = into_the_open(costmap, *wave_cells_, *wave_legs_, start_map, std::nullopt);
  if (!out) return lengths_;
  search_.begin(costmap, *wave_cells_, *wave_legs_,
                costmap.coarse().index_of(cell_at(out->back(), costmap.cell_size_m())), std::nullopt);
  wave_first_m_ = length_of(*out);
  wave_expansions_ = 0;
  lengths_.is_whole_ = false;
  return reach_farther(most_m);
}

const RouteLengths& PathPlanner::reach_farther(double most_m) {
  if (lengths_.is_whole_) return lengths_;
  lengths_.is_whole_ = true;
  search_.take_up();
  const CoarseGrid& coarse = lengths_.grid_;
  const double coarse_m = kCoarseSide * lengths_.cell_size_m_;
  while (const auto settled = search_.next()) {
    const std::size_t i = settled->index, before = search_.before(i);
    const double length_m =
        before == i ? wave_first_m_ : lengths_.length_m_[before] + coarse_m * search_.last_step(i);
    if (length_m > most_m) {
      lengths_.is_whole_ = false;
      search_.put_aside(*settled);
      continue;
    }
    lengths_.length_m_[i] = static_cast<float>(length_m);
    // Where it stands already it leaves as it came.
    lengths_.leads_by_post_[i] =
        lengths_.leads_by_post_[before] || (coarse[i].by_post() && !coarse[before].by_post());
    if (++wave_expansions_ > config_.most_expansions) break;
    search_.expand(*settled);
  }
  return lengths_;
}

}  // namespace dynslam
