// SPDX-License-Identifier: MIT
#include "autopilot/autopilot.h"

#include <algorithm>
#include <utility>

namespace dynslam {
namespace {

using Remedy = Hindrance::Remedy;

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

constexpr double kPatienceAmongMany_s = 4.0, kPatienceForOne_s = 7.0;
/// What changes in the map is taken in so often: the nearest of it is the follower's business.
constexpr Duration kMapsEvery = std::chrono::milliseconds(400);
constexpr Duration kBacksOff = std::chrono::milliseconds(2200);
constexpr Duration kTouchesCountFor = std::chrono::minutes(1);

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
      explorer_(setup.exploration, setup.autopilot) {}

const AutopilotStatus& Autopilot::turn(Time now, const AutopilotInputs& in) {
  for (const Order& order : in.orders) take(now, order);
  if (in.is_steered && is_on()) {
    take(now, SwitchOff{});
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

void Autopilot::take(Time now, const Order& order) {
  ordered_at_ = now;
  ++status_.errand;
  errand_ = order;
  flees_ = false;
  stop_ = failed_stops_ = 0;
  trust();
  const bool explores = std::holds_alternative<Explore>(order);
  status_.mode = explores ? AutopilotMode::kExploration : AutopilotMode::kNavigation;
  if (std::holds_alternative<SwitchOff>(order)) return end(AutopilotPhase::kOff, "");
  if (std::holds_alternative<StandBy>(order)) return end(AutopilotPhase::kIdle, "waiting for a destination");
  end(AutopilotPhase::kActive, "");
}

/// Whatever was under way is over.
void Autopilot::end(AutopilotPhase phase, const std::string& reason) {
  navigator_.give_up();
  explorer_.begin();
  explored_ = false;
  rests_until_.reset();
  hindered_since_.reset();
  backs_off_until_.reset();
  status_.phase = phase;
  status_.reason = reason;
  status_.goal.reset();
  status_.nearest_map.reset();
}

void Autopilot::observe(Time now, const AutopilotInputs& in) {
  if (!in.world || !is_on()) return;
  const GridSnapshot& map = in.world->map;
  if (!costmap_) costmap_.emplace(map.cell_size_m());
  const bool is_news = in.notes && in.notes != notes_;
  if (is_news) notes_ = in.notes;
  const bool felt_less = felt_.forget(now);
  const bool sees_glass = glass_.see(now, in.glass_map, in.world->pose.map_T_robot.translation());
  if (felt_less || sees_glass || is_news) keep_out();
  if (!mapped_at_ || now < *mapped_at_ || now - *mapped_at_ >= kMapsEvery) {
    costmap_->update(map);
    mapped_at_ = now;
  }
  explorer_.observe(now, map, in.world->pose);
}

void Autopilot::keep_out() {
  std::vector<std::vector<Vector2>> outlines = felt_.outlines_map();
  for (auto& pane : glass_.outlines_map()) outlines.push_back(std::move(pane));
  if (notes_) outlines.insert(outlines.end(), notes_->forbidden_map.begin(), notes_->forbidden_map.end());
  costmap_->set_forbidden(outlines);
}

/// What was doubted counts again.
void Autopilot::trust() {
  const bool felt = felt_.trust(), glass = glass_.trust();
  if ((felt || glass) && costmap_) keep_out();
}

/// From what it touched. Whatever else hinders it ends this, and so does a touch that does not end.
bool Autopilot::free_itself(Time now, const AutopilotInputs& in, const std::optional<Hindrance>& hindrance) {
  const bool touches = hindrance && hindrance->remedy == Remedy::kBackOff;
  if (hindrance && !touches) backs_off_until_.reset();
  if (backs_off_until_ && now < *backs_off_until_) return true;
  const bool tried = std::exchange(backs_off_until_, std::nullopt).has_value();
  if (!touches) return false;
  if (tried) {
    end(AutopilotPhase::kStopped, hindrance->reason);
  } else {
    back_off(now, in, hindrance->reason);
  }
  return true;
}

/// For a moment, and remembers where that was; when that comes too often, a person has to look.
void Autopilot::back_off(Time now, const AutopilotInputs& in, const std::string& from) {
  const auto lately = felt_.count_since(std::max(now - kTouchesCountFor, ordered_at_));
  if (!in.condition.pose || !costmap_ || lately >= static_cast<std::size_t>(config_.most_touches))
    return end(AutopilotPhase::kStopped, from);
  felt_.touched(now, in.condition.pose->map_T_robot, in.came, robot_radius_m_);
  keep_out();
  navigator_.plan_anew();
  backs_off_until_ = now + kBacksOff;
  status_.reason = from + ", and backs off";
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
  errand_ = GoHome{};
  flees_ = true;
  status_.mode = AutopilotMode::kNavigation;
}

void Autopilot::drive(Time now, const AutopilotInputs& in) {
  hindered_since_.reset();
  const Pose2& map_T_robot = in.world->pose.map_T_robot;
  const bool has_aim = navigator_.destination().has_value();
  if (explores() || !has_aim) {
    if (!set_out(now, map_T_robot.translation())) return;
  }
  const Navigator::Report report = navigator_.turn(now, map_T_robot, *costmap_, in.follow);
  status_.reason = report.reason;
  if (report.state == Navigator::State::kArrived) return arrived(now, report.reason);
  if (report.state == Navigator::State::kStuck) return stuck(now, in);
  if (report.state == Navigator::State::kNoRoute) failed(now, report);
}

/// In what neither lidar nor bumper tells of.
void Autopilot::stuck(Time now, const AutopilotInputs& in) {
  back_off(now, in, "the wheels turn and the robot stays");
  if (explores() && explorer_.aim()) explorer_.failed(now);
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

bool Autopilot::explore(Time now, const Vector2& robot_map) {
  const bool is_new = explorer_.choose(now, robot_map, *costmap_, planner_);
  if (explorer_.is_over() && felt_.doubt()) {
    while (felt_.doubt()) continue;
    keep_out();
    explorer_.begin();
    return false;
  }
  if (explorer_.is_over() && config_.when_explored != "revisit") {
    finish_exploring();
    return false;
  }
  if (!explorer_.aim()) {
    navigator_.give_up();
    status_.goal.reset();
    status_.reason =
        explorer_.is_over() ? "everything within reach is mapped" : "looking whether all is mapped";
    return false;
  }
  // There is enough to do elsewhere meanwhile, and what is left alone is tried again.
  const bool among_many = explorer_.places().size() > 1;
  if (is_new)
    set_out_to({explorer_.aim()->stand_map}, false, among_many ? kPatienceAmongMany_s : kPatienceForOne_s);
  return true;
}

void Autopilot::finish_exploring() {
  if (config_.when_explored == "home") {
    end(AutopilotPhase::kActive, "");
    errand_ = GoHome{};
  } else {
    end(AutopilotPhase::kIdle, explorer_.waits_for_door()
                                   ? "everything is mapped but what lies behind closed doors"
                                   : "everything within reach is mapped");
  }
  explored_ = true;
}

void Autopilot::arrived(Time now, const std::string& remark) {
  failed_stops_ = 0;
  if (explores()) return explorer_.reached(now);
  trust();
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
  if (explores()) return explorer_.failed(now);
  if (felt_.doubt() || glass_.doubt()) return keep_out();
  trust();
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
  if (!explores()) return;
  for (const Place& place : explorer_.places())
    status_.places.push_back({word_of(place.kind), place.point_map});
}

}  // namespace dynslam
