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

json pose_json(const PoseEstimate& p) {
  return {{"t_s", rounded(seconds_of(p.stamp))}, {"x_m", rounded(p.map_T_robot.x)},
          {"y_m", rounded(p.map_T_robot.y)},     {"yaw_rad", rounded(p.map_T_robot.yaw)},
          {"quality", rounded(p.quality)},       {"lost", p.lost}};
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
  state["verdict"] = {{"motion", to_string(d.verdict.motion)}, {"reason", d.verdict.reason}};
  state["applied"] = {{"v_mps", rounded(d.applied.v_mps)}, {"w_radps", rounded(d.applied.w_radps)}};
  state["power"] = {{"left", rounded(d.power.left)}, {"right", rounded(d.power.right)}};
  state["battery"] = {{"voltage_v", rounded(d.battery.voltage_v, 100)},
                      {"share", rounded(d.battery.share, 1000)},
                      {"level", to_string(d.battery.level)},
                      {"brownout", d.battery.brownout}};
}

json counters_json(const Counters& counters) {
  json all = json::object();
  for (const auto& [name, n] : counters) all[name] = n;
  return all;
}

json device_json(const DeviceHealth* health) {
  if (!health) return {{"present", false}};
  return {{"present", health->present},
          {"samples", health->samples},
          {"errors", health->errors},
          {"last_sample_s", rounded(seconds_of(health->last_sample))},
          {"trouble", health->trouble}};
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
                {"scan", nullptr},
                {"recording", nullptr},
                {"driver", nullptr}};
  if (const auto world = ports.world.get().value) state["pose"] = pose_json(world->pose);
  if (const auto drive = ports.drive.get().value) add_drive(state, *drive);
  if (const auto scan = ports.scan.get().value) {
    state["scan"] = {{"seq", extras.scan_version},
                     {"t_s", rounded(seconds_of(scan->stamp))},
                     {"ranges_cm", coarse_ranges_cm(*scan)}};
  }
  state["power_limit"] = rounded(ports.power_limit);
  state["watchers"] = ports.watchers.load();
  if (extras.driver) state["driver"] = *extras.driver;
  state["recording"] = recording_json(ports);
  state["counters"] = counters_json(extras.counters);
  return state;
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
  const auto add = [&all](const char* name, const Latest<DeviceHealth>& health) {
    all[name] = device_json(health.get().value.get());
  };
  add("lidar", ports.lidar_health);
  add("imu", ports.imu_health);
  add("motors", ports.motors_health);
  add("camera", ports.camera_health);
  add("pins", ports.pins_health);
  json counters = json::object();
  for (const auto* part : {&ports.slam_counters, &ports.graph_counters, &ports.drive_counters})
    if (const auto counted = part->get().value) counters.update(counters_json(*counted));
  return {{"devices", all}, {"counters", counters}};
}

}  // namespace dynslam
