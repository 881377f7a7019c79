// SPDX-License-Identifier: MIT
#include "autopilot/autopilot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dynslam {
namespace {

using Remedy = Hindrance::Remedy;

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};

/// Two places so near to each other are one.
constexpr double kSamePlace_m = 0.6;
constexpr Duration kSure = std::chrono::seconds(5);
constexpr double kSeenFrom_m = 0.8;
constexpr std::size_t kMostRemembered = 1000;
constexpr double kPatienceAmongMany_s = 4.0;
/// Routes are looked for within so far of the robot first; a map with longer ones than the second is looked
/// at whole.
constexpr double kLooksFirst_m = 12.0, kLooksAll_m = 100.0;
constexpr Duration kBacksOff = std::chrono::milliseconds(2200);
constexpr Duration kTouchesCountFor = std::chrono::minutes(1);

bool is_near_any(const std::deque<Vector2>& points, const Vector2& point) {
  return std::any_of(points.begin(), points.end(),
                     [&](const Vector2& p) { return (p - point).norm() < kSamePlace_m; });
}

std::string_view word_of(PlaceKind kind) {
  switch (kind) {
    case PlaceKind::kFrontier:
      return "frontier";
    case PlaceKind::kUnvisited:
      return "unvisited";
    case PlaceKind::kOld:
      break;
  }
  return "old";
}

}  // namespace

Autopilot::Autopilot(const AutopilotSetup& setup)
    : config_(setup.autopilot),
      robot_radius_m_(setup.robot_radius_m),
      planner_(setup.planner, setup.robot_radius_m),
      navigator_(setup.navigation, planner_),
      exploration_(setup.exploration),
      frontier_map_(setup.exploration) {}

const AutopilotStatus& Autopilot::turn(Time now, const AutopilotInputs& in) {
  for (const Order& order : in.orders) take(order);
  if (in.is_steered && is_on()) {
    take(SwitchOff{});
    status_.reason = "a person took the wheel";
  }
  observe(now, in);
  look_round_radps_ = 0.0;
  if (status_.phase == AutopilotPhase::kActive) {
    const auto hindrance = hindrance_of(in.condition);
    if (!free_itself(now, in, hindrance) && (!hindrance || bear(now, in, *hindrance))) drive(now, in);
  }
  show(now, in);
  return status_;
}

void Autopilot::take(const Order& order) {
  ++status_.errand;
  errand_ = order;
  flees_ = false;
  stop_ = failed_stops_ = 0;
  const bool explores = std::holds_alternative<Explore>(order);
  status_.mode = explores ? AutopilotMode::kExploration : AutopilotMode::kNavigation;
  if (std::holds_alternative<SwitchOff>(order)) return end(AutopilotPhase::kOff, "");
  if (std::holds_alternative<StandBy>(order)) return end(AutopilotPhase::kIdle, "waiting for a destination");
  end(AutopilotPhase::kActive, "");
}

/// Whatever was under way is over.
void Autopilot::end(AutopilotPhase phase, const std::string& reason) {
  navigator_.give_up();
  place_.reset();
  rests_until_.reset();
  chosen_at_.reset();
  hindered_since_.reset();
  backs_off_until_.reset();
  seems_explored_since_.reset();
  explored_ = false;
  places_.clear();
  once_reachable_.clear();
  status_.phase = phase;
  status_.reason = reason;
  status_.goal.reset();
  status_.nearest_map.reset();
}

void Autopilot::observe(Time now, const AutopilotInputs& in) {
  if (!in.world || !is_on()) return;
  map_ = in.world->map;
  if (!costmap_) costmap_.emplace(map_.cell_size_m());
  const bool is_news = in.notes && in.notes != notes_;
  if (is_news) notes_ = in.notes;
  if (felt_.forget(now) || is_news) keep_out();
  costmap_->update(map_);
  frontier_map_.update(map_);
  if (!in.world->pose.lost) visits_.note(now, in.world->pose.map_T_robot.translation());
}

void Autopilot::keep_out() {
  std::vector<std::vector<Vector2>> outlines = felt_.outlines_map();
  if (notes_) outlines.insert(outlines.end(), notes_->forbidden_map.begin(), notes_->forbidden_map.end());
  costmap_->set_forbidden(outlines);
}

/// Backs off from what it touched, for a moment, and remembers where that was. Whatever else hinders it ends
/// this, and so does a touch that does not end, or comes too often.
bool Autopilot::free_itself(Time now, const AutopilotInputs& in, const std::optional<Hindrance>& hindrance) {
  const bool touches = hindrance && hindrance->remedy == Remedy::kBackOff;
  if (hindrance && !touches) backs_off_until_.reset();
  if (backs_off_until_ && now < *backs_off_until_) return true;
  const bool tried = std::exchange(backs_off_until_, std::nullopt).has_value();
  if (!touches) return false;
  const auto lately = felt_.count_since(now - kTouchesCountFor);
  if (tried || !in.condition.pose || !costmap_ || lately >= static_cast<std::size_t>(config_.most_touches)) {
    end(AutopilotPhase::kStopped, hindrance->reason);
    return true;
  }
  felt_.touched(now, in.condition.pose->map_T_robot, in.came, robot_radius_m_);
  keep_out();
  navigator_.plan_anew();
  backs_off_until_ = now + kBacksOff;
  status_.reason = "it touched something, and backs off";
  return true;
}

/// It stands, and waits for better times, but not for ever. Returns whether it drives all the same: home.
bool Autopilot::bear(Time now, const AutopilotInputs& in, const Hindrance& hindrance) {
  if (hindrance.remedy == Remedy::kGoHome && in.notes && in.notes->home) {
    go_home();
    return true;
  }
  if (!hindered_since_ || now < *hindered_since_) hindered_since_ = now;
  const bool waits = hindrance.remedy == Remedy::kWait || hindrance.remedy == Remedy::kLookRound;
  if (!waits || now - *hindered_since_ > from_seconds(config_.patience_s)) {
    end(AutopilotPhase::kStopped, hindrance.reason);
    return false;
  }
  status_.reason = hindrance.reason;
  if (hindrance.remedy == Remedy::kLookRound && config_.looks_round)
    look_round_radps_ = config_.look_round_radps;
  return false;
}

void Autopilot::go_home() {
  if (flees_) return;
  navigator_.give_up();
  place_.reset();
  errand_ = GoHome{};
  flees_ = true;
  status_.mode = AutopilotMode::kNavigation;
}

void Autopilot::drive(Time now, const AutopilotInputs& in) {
  hindered_since_.reset();
  const Pose2& map_T_robot = in.world->pose.map_T_robot;
  const bool explores = std::holds_alternative<Explore>(errand_);
  if (explores && place_ && is_seen(*place_)) {
    exploration_.vanished(now, *place_);
    place_.reset();
    navigator_.give_up();
  }
  const bool has_aim = navigator_.destination().has_value();
  if (explores || !has_aim) {
    if (!set_out(now, map_T_robot.translation())) return;
  }
  const Navigator::Report report = navigator_.turn(now, map_T_robot, *costmap_, in.follow);
  status_.reason = report.reason;
  if (report.state == Navigator::State::kArrived) return arrived(now, report.reason);
  if (report.state == Navigator::State::kStuck)
    return end(AutopilotPhase::kStopped, "the wheels turn and the robot stays");
  if (report.state == Navigator::State::kNoRoute) failed(now, report);
}

/// Chooses what to drive to; false when there is nothing for now.
bool Autopilot::set_out(Time now, const Vector2& robot_map) {
  if (rests_until_ && now < *rests_until_) return false;
  rests_until_.reset();
  return std::visit(Overloaded{[&](const Explore&) { return explore(now, robot_map); },
                               [&](const GoThere& there) { return set_out_to(there.to, true), true; },
                               [&](const GoHome&) {
                                 const Destination start{Vector2::Zero(), 0.0, "the start"};
                                 return set_out_to(notes_ && notes_->home ? *notes_->home : start, true),
                                        true;
                               },
                               [&](const Patrol& patrol) {
                                 if (patrol.stops.empty())
                                   return end(AutopilotPhase::kStopped, "a patrol of no places"), false;
                                 return set_out_to(patrol.stops[stop_ % patrol.stops.size()], true), true;
                               },
                               [](const auto&) { return false; }},
                    errand_);
}

void Autopilot::set_out_to(const Destination& to, bool stops, std::optional<double> patience_s) {
  navigator_.set_out(to, stops, patience_s);
  status_.goal = to;
  status_.nearest_map.reset();
}

/// Looks for the best place from time to time, and at once when there is none.
bool Autopilot::explore(Time now, const Vector2& robot_map) {
  const Duration choose_every = from_seconds(config_.choose_every_s);
  const bool is_due = !chosen_at_ || now < *chosen_at_ || now >= *chosen_at_ + choose_every;
  if (place_ && !is_due) return true;
  chosen_at_ = now;
  find_places(now, robot_map);
  if (explored_ && config_.when_explored != "revisit") {
    finish_exploring();
    return false;
  }
  // Who does not go on for ever stands still to make sure, unless a door has to be looked at.
  if (config_.when_explored != "revisit" && !waits_for_door_)
    std::erase_if(places_, [](const Place& p) { return p.kind != PlaceKind::kFrontier; });
  if (places_.empty()) {
    place_.reset();
    navigator_.give_up();
    status_.reason = explored_ ? "everything within reach is mapped" : "looking whether all is mapped";
    rests_until_ = now + choose_every;
    return false;
  }
  const Place& best = places_.front();
  if (place_ && (place_->stand_map - best.stand_map).norm() < kSamePlace_m) return true;
  place_ = best;
  // There is enough to do elsewhere meanwhile.
  set_out_to({best.stand_map}, false,
             places_.size() > 1 ? std::optional(kPatienceAmongMany_s) : std::nullopt);
  return true;
}

void Autopilot::find_places(Time now, const Vector2& robot_map) {
  double looked_m = kLooksFirst_m;
  const RouteLengths* lengths = &planner_.reach(*costmap_, robot_map, looked_m);
  const auto look_farther = [&] {
    if (std::isinf(looked_m)) return false;
    looked_m = looked_m < kLooksAll_m ? 4.0 * looked_m : std::numeric_limits<double>::infinity();
    lengths = &planner_.reach(*costmap_, robot_map, looked_m);
    return true;
  };
  const Reachability reach{
      [&](const Vector2& point) { return lengths->length_m(point); },
      [&](const Vector2& point, double within_m) { return lengths->nearest_reached(point, within_m); },
      [&] { return looked_m; }, look_farther};
  const std::vector<Frontier> frontiers = frontier_map_.frontiers();
  // A door is seen to be open again by who passes by.
  places_ = exploration_.places(now, robot_map, frontiers, visits_, map_, reach, waits_for_door_);
  for (const Place& place : places_) {
    if (place.kind != PlaceKind::kFrontier) break;
    if (!is_near_any(once_reachable_, place.point_map)) once_reachable_.push_back(place.point_map);
    if (once_reachable_.size() > kMostRemembered) once_reachable_.pop_front();
  }
  const auto has_lost_its_way = [&](const Frontier& f) {
    return !reach.nearest(f.middle_map, kSeenFrom_m) && is_near_any(once_reachable_, f.middle_map);
  };
  waits_for_door_ = std::isinf(looked_m) && std::any_of(frontiers.begin(), frontiers.end(), has_lost_its_way);
  judge_explored(now);
}

/// All is explored when for some time there was nothing to go to for the first time. Whoever stands in a
/// doorway goes on soon; a door that was shut behind the robot is waited for longer.
void Autopilot::judge_explored(Time now) {
  const bool has_frontier = !places_.empty() && places_.front().kind == PlaceKind::kFrontier;
  if (has_frontier || exploration_.left_out().next) {
    seems_explored_since_.reset();
  } else if (!seems_explored_since_ || now < *seems_explored_since_) {
    seems_explored_since_ = now;
  }
  const Duration patience = waits_for_door_ ? from_seconds(config_.door_patience_s) : kSure;
  explored_ = seems_explored_since_ && now - *seems_explored_since_ >= patience;
}

void Autopilot::finish_exploring() {
  if (config_.when_explored == "home") {
    end(AutopilotPhase::kActive, "");
    errand_ = GoHome{};
  } else {
    end(AutopilotPhase::kIdle, waits_for_door_ ? "everything is mapped but what lies behind closed doors"
                                               : "everything within reach is mapped");
  }
  explored_ = true;
}

/// What a frontier hid is often seen long before the robot is there.
bool Autopilot::is_seen(const Place& place) const {
  if (place.kind != PlaceKind::kFrontier) return false;
  for (const Frontier& f : frontier_map_.frontiers())
    if ((f.middle_map - place.point_map).norm() < kSamePlace_m + 0.5 * f.extent_m) return false;
  return true;
}

void Autopilot::arrived(Time now, const std::string& remark) {
  failed_stops_ = 0;
  if (place_) {
    exploration_.reached(now, *place_);
    place_.reset();
    return;
  }
  if (std::holds_alternative<Patrol>(errand_)) {
    ++stop_;
    rests_until_ = now + from_seconds(config_.patrol_pause_s);
    return;
  }
  const std::string where = status_.goal && !status_.goal->name.empty() ? " at " + status_.goal->name : "";
  const std::string as_near = remark.empty() ? "" : ", as near as it can come: " + remark;
  if (flees_) return end(AutopilotPhase::kStopped, "the battery is nearly empty; it drove home");
  end(AutopilotPhase::kIdle, "arrived" + where + as_near);
}

void Autopilot::failed(Time now, const Navigator::Report& report) {
  if (place_) {
    exploration_.failed(now, *place_);
    place_.reset();
    return;
  }
  if (const auto* patrol = std::get_if<Patrol>(&errand_)) {
    ++stop_;
    if (++failed_stops_ < patrol->stops.size()) return;
  }
  const auto goal = status_.goal;
  end(AutopilotPhase::kStopped, "no route: " + report.reason);
  status_.goal = goal;
  status_.nearest_map = report.nearest_map;
}

void Autopilot::show(Time now, const AutopilotInputs& in) {
  status_.time = now;
  status_.route_map.clear();
  status_.remaining_m.reset();
  const auto& task = navigator_.task();
  if (task) {
    const bool is_news = in.follow.task == task->id && !in.follow.route_map.empty();
    status_.route_map = is_news ? in.follow.route_map : task->route_map;
    double length_m = 0.0;
    for (std::size_t i = 1; i < status_.route_map.size(); ++i)
      length_m += (status_.route_map[i] - status_.route_map[i - 1]).norm();
    status_.remaining_m = length_m;
  }
  status_.places.clear();
  if (!std::holds_alternative<Explore>(errand_)) return;
  for (const Place& place : places_) status_.places.push_back({word_of(place.kind), place.point_map});
}

}  // namespace dynslam
