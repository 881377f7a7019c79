// SPDX-License-Identifier: MIT
#include "server/state_json.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

namespace dynslam {
namespace {

using nlohmann::json;

/// Enough for what is shown, and short.
double rounded(double value, double parts = 1e4) {
  return std::isfinite(value) ? std::round(value * parts) / parts : 0.0;
}

json place_json(const Pose2& pose) {
  return {{"x_m", rounded(pose.x)}, {"y_m", rounded(pose.y)}, {"yaw_rad", rounded(pose.yaw)}};
}

/// Millimetres count here. What is not known at all is not told as exact.
json covariance_json(const Eigen::Matrix3d& c) {
  constexpr double kParts = 1e9, kUnknown = 1e6;
  const auto variance = [](double v) { return std::isfinite(v) ? rounded(v, kParts) : kUnknown; };
  return {{"xx_m2", variance(c(0, 0))},
          {"xy_m2", rounded(c(0, 1), kParts)},
          {"yy_m2", variance(c(1, 1))},
          {"yaw_rad2", variance(c(2, 2))}};
}

json unsteady_json(Unsteady unsteady) {
  if (unsteady == Unsteady::kNo) return nullptr;
  return unsteady == Unsteady::kTurning ? "turning" : "tilting";
}

json pose_json(const PoseEstimate& p) {
  json pose = place_json(p.map_T_robot);
  pose.update({{"t_s", rounded(seconds_of(p.stamp))},
               {"covariance", covariance_json(p.covariance)},
               {"quality", rounded(p.quality)},
               {"lost", p.lost},
               {"unsteady", unsteady_json(p.unsteady)}});
  return pose;
}

const char* to_string(BatteryLevel level) {
  switch (level) {
    case BatteryLevel::kGood:
      return "good";
    case BatteryLevel::kLow:
      return "low";
    case BatteryLevel::kRecharge:
      return "recharge";
    case BatteryLevel::kUnknown:
      break;
  }
  return "unknown";
}

void add_drive(json& state, const DriveState& d) {
  state["verdict"] = {
      {"motion", to_string(d.verdict.motion)}, {"cause", to_string(d.cause)}, {"reason", d.verdict.reason}};
  state["applied"] = {{"v_mps", rounded(d.applied.v_mps)}, {"w_radps", rounded(d.applied.w_radps)}};
  state["power"] = {{"left", rounded(d.power.left)}, {"right", rounded(d.power.right)}};
  state["battery"] = {{"voltage_v", rounded(d.battery.voltage_v, 100)},
                      {"share", rounded(d.battery.share, 1000)},
                      {"level", to_string(d.battery.level)},
                      {"brownout", d.battery.brownout}};
  if (d.attitude) {
    state["attitude"] = {{"roll_rad", rounded(d.attitude->roll_rad)},
                         {"pitch_rad", rounded(d.attitude->pitch_rad)},
                         {"yaw_radps", rounded(d.attitude->yaw_radps)}};
  }
  if (d.collision) state["collision"] = *d.collision;
}

/// For drawing; so many points say enough.
json route_json(const std::vector<Vector2>& route) {
  constexpr std::size_t kMost = 200;
  const std::size_t n = std::min(route.size(), kMost);
  json points = json::array();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2& p = route[n == 1 ? 0 : i * (route.size() - 1) / (n - 1)];
    points.push_back({rounded(p.x(), 100), rounded(p.y(), 100)});
  }
  return points;
}

json goal_json(const Destination& goal) {
  json out = {{"x_m", rounded(goal.point_map.x())}, {"y_m", rounded(goal.point_map.y())}};
  if (goal.yaw_rad) out["yaw_rad"] = rounded(*goal.yaw_rad);
  if (!goal.name.empty()) out["name"] = goal.name;
  return out;
}

const char* to_string(AutopilotPhase phase) {
  switch (phase) {
    case AutopilotPhase::kActive:
      return "active";
    case AutopilotPhase::kIdle:
      return "idle";
    case AutopilotPhase::kStopped:
    case AutopilotPhase::kOff:
      break;
  }
  return "stopped";
}

const char* to_string(AutopilotMode mode) {
  return mode == AutopilotMode::kExploration ? "explore" : "navigate";
}

void add_autopilot(json& state, const AutopilotStatus& a) {
  constexpr std::size_t kMostShown = 64;
  json places = json::array();
  for (std::size_t i = 0; i < std::min(a.places.size(), kMostShown); ++i) {
    const PlaceShown& p = a.places[i];
    places.push_back(
        {{"kind", p.kind}, {"x_m", rounded(p.point_map.x(), 100)}, {"y_m", rounded(p.point_map.y(), 100)}});
  }
  json autopilot = {{"mode", to_string(a.mode)},
                    {"phase", to_string(a.phase)},
                    {"reason", a.reason},
                    {"goal", nullptr},
                    {"route", route_json(a.route_map)},
                    {"remaining_m", nullptr},
                    {"places", places},
                    {"nearest", nullptr}};
  if (a.goal) autopilot["goal"] = goal_json(*a.goal);
  if (a.remaining_m) autopilot["remaining_m"] = rounded(*a.remaining_m, 100);
  if (a.nearest_map) autopilot["nearest"] = {rounded(a.nearest_map->x()), rounded(a.nearest_map->y())};
  state["mode"] = to_string(a.mode);
  state["autopilot"] = std::move(autopilot);
}

const char* to_string(LogLevel level) {
  switch (level) {
    case LogLevel::kInfo:
      return "info";
    case LogLevel::kWarn:
      return "warn";
    case LogLevel::kError:
      return "error";
    case LogLevel::kFatal:
      return "fatal";
    case LogLevel::kDebug:
      break;
  }
  return "debug";
}

json counters_json(const Counters& counters) {
  json all = json::object();
  for (const auto& [name, n] : counters) all[name] = n;
  return all;
}

json device_json(const DeviceHealth* health) {
  if (!health) return {{"present", false}};
  return {{"present", health->present}, {"samples", health->samples},
          {"errors", health->errors},   {"last_sample_s", rounded(seconds_of(health->last_sample))},
          {"trouble", health->trouble}, {"about", health->about}};
}

}  // namespace

std::array<std::uint16_t, 360> coarse_ranges_cm(const Scan& scan) {
  std::array<std::uint16_t, 360> ranges{};
  const LidarMount& mount = scan.mount;
  for (const Beam& beam : scan.beams) {
    if (!is_return(beam)) continue;
    const double angle = mount.upside_down ? -beam.angle_rad : beam.angle_rad;
    const Vector2 hit_robot =
        mount.robot_T_lidar * Vector2(beam.range_m * std::cos(angle), beam.range_m * std::sin(angle));
    const double cm = std::round(100.0 * hit_robot.norm());
    if (!(cm >= 1.0 && cm <= 65535.0)) continue;
    const double degree = std::round(std::atan2(hit_robot.y(), hit_robot.x()) * 180.0 / std::numbers::pi);
    std::uint16_t& kept = ranges[static_cast<std::size_t>(degree < 0.0 ? degree + 360.0 : degree) % 360];
    if (kept == 0 || cm < kept) kept = static_cast<std::uint16_t>(cm);
  }
  return ranges;
}

json state_json(const Ports& ports, const StateExtras& extras) {
  json state = {{"t_s", rounded(seconds_of(extras.now))},
                {"pose", nullptr},
                {"mode", "manual"},
                {"autopilot", nullptr},
                {"verdict", nullptr},
                {"applied", nullptr},
                {"power", nullptr},
                {"battery", nullptr},
                {"attitude", nullptr},
                {"collision", nullptr},
                {"scan", nullptr},
                {"recording", nullptr},
                {"driver", nullptr}};
  if (const auto world = ports.world.get().value) state["pose"] = pose_json(world->pose);
  if (const auto drive = ports.drive.get().value) add_drive(state, *drive);
  const auto autopilot = ports.autopilot.get().value;
  if (autopilot && autopilot->phase != AutopilotPhase::kOff) add_autopilot(state, *autopilot);
  if (const auto scan = ports.scan.get().value) {
    state["scan"] = {{"seq", extras.scan_version},
                     {"t_s", rounded(seconds_of(scan->stamp))},
                     {"ranges_cm", coarse_ranges_cm(*scan)}};
  }
  state["power_limit"] = rounded(ports.power_limit);
  state["watchers"] = ports.watchers.load();
  if (extras.driver) state["driver"] = *extras.driver;
  state["map_id"] = extras.map_id;
  state["notes_version"] = extras.notes_version;
  state["recording"] = recording_json(ports);
  state["counters"] = counters_json(extras.counters);
  return state;
}

json graph_json(const Ports& ports) {
  json maps = json::array(), closures = json::array();
  if (const auto graph = ports.graph.get().value) {
    for (const GraphNode& map : graph->local_maps) {
      maps.push_back(place_json(map.map_T_node));
      maps.back()["id"] = map.id;
    }
    for (const GraphView::Closure& c : graph->closures) closures.push_back({{"from", c.from}, {"to", c.to}});
  }
  return {{"local_maps", maps}, {"closures", closures}};
}

json log_json(const Ports& ports) {
  json lines = json::array();
  for (const LogLine& line : ports.recent_log.all())
    lines.push_back(
        {{"t_s", rounded(seconds_of(line.time))}, {"level", to_string(line.level)}, {"text", line.text}});
  return {{"lines", lines}};
}

json recording_json(const Ports& ports) {
  const auto r = ports.recording.get().value;
  if (!r) return nullptr;
  return {{"active", r->active},
          {"asked_for", r->asked_for},
          {"file", r->file.substr(r->file.find_last_of('/') + 1)},
          {"bytes", r->bytes},
          {"messages", r->messages},
          {"seconds", rounded(r->seconds)},
          {"dropped", r->dropped},
          {"trouble", r->trouble}};
}

json devices_json(const Ports& ports) {
  json all = json::object();
  for (const auto& [name, health] : ports.device_healths())
    all[name] = device_json(health->get().value.get());
  return {{"devices", all}, {"counters", counters_json(ports.counters())}};
}

std::string text_of(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace dynslam
