// SPDX-License-Identifier: MIT
#include "robot/event_writer.h"

#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include "base/number_text.h"
#include "grid/trinary_map.h"

namespace dynslam {
namespace {

constexpr Duration kHealthEvery = std::chrono::seconds(1);
constexpr Duration kBatteryEvery = std::chrono::seconds(1);
constexpr Duration kMapEvery = std::chrono::seconds(10);
constexpr Duration kStale = std::chrono::seconds(2);

using Level = DiagnosticStatus::Level;

DiagnosticStatus status_of(const std::string& name, const DeviceHealth& health, Time now) {
  DiagnosticStatus status{Level::kOk, name, "answers"};
  if (now - health.last_sample > kStale) {
    status.level = Level::kStale;
    status.message = "silent";
  }
  if (!health.trouble.empty()) {
    status.level = Level::kError;
    status.message = health.trouble;
  }
  status.values = {{"samples", std::to_string(health.samples)}, {"errors", std::to_string(health.errors)}};
  if (!health.about.empty()) status.values.emplace_back("about", health.about);
  for (const auto& [what, n] : health.counters) status.values.emplace_back(what, std::to_string(n));
  return status;
}

DiagnosticStatus status_of(const Verdict& verdict) {
  const Level level = verdict.motion >= Motion::kStop ? Level::kError
                      : verdict.motion > Motion::kGo  ? Level::kWarn
                                                      : Level::kOk;
  return {level, "drive", verdict.reason, {{"motion", to_string(verdict.motion)}}};
}

DiagnosticStatus status_of(const PoseEstimate& pose) {
  DiagnosticStatus status{Level::kOk, "slam", "knows where it is"};
  if (pose.lost) status = {Level::kError, "slam", "lost"};
  status.values = {{"quality", shortest_text(pose.quality)}};
  return status;
}

LogLine log_line(Time time, const Verdict& verdict) {
  const LogLevel level = verdict.motion >= Motion::kStop ? LogLevel::kWarn : LogLevel::kInfo;
  return {time, level, std::string(to_string(verdict.motion)) + ": " + verdict.reason};
}

std::string centimetres_text(double metres) { return shortest_text(std::round(100.0 * metres) / 100.0); }

/// What it is about; empty: people drive.
std::string in_words(const AutopilotStatus& status) {
  switch (status.phase) {
    case AutopilotPhase::kActive: {
      std::string text = status.mode == AutopilotMode::kExploration ? "explores" : "drives";
      if (status.goal) {
        const Vector2& to = status.goal->point_map;
        text += ", to " + centimetres_text(to.x()) + ", " + centimetres_text(to.y());
      }
      return text;
    }
    case AutopilotPhase::kIdle:
      return "has nothing to do";
    case AutopilotPhase::kStopped:
      return "cannot go on";
    case AutopilotPhase::kOff:
      break;
  }
  return {};
}

std::size_t hash_of(const TrinaryMap& map) {
  return std::hash<std::string_view>()({reinterpret_cast<const char*>(map.cells.data()), map.cells.size()});
}

}  // namespace

void EventWriter::write(const RecorderEvent& event) {
  const Time at = event.time;
  if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&event.what)) ros_.write(at, **scan);
  if (const auto* imu = std::get_if<ImuSample>(&event.what)) ros_.write(at, *imu);
  if (const auto* wheels = std::get_if<OdometrySample>(&event.what)) ros_.write(at, *wheels);
  if (const auto* command = std::get_if<DriveCommand>(&event.what)) ros_.write(at, *command);
  if (const auto* picture = std::get_if<std::shared_ptr<const JpegFrame>>(&event.what))
    ros_.write(at, **picture);
  if (const auto* drive = std::get_if<std::shared_ptr<const DriveState>>(&event.what))
    write_drive(at, **drive);
  if (const auto* fix = std::get_if<PoseFix>(&event.what)) {
    ros_.write(at, *fix);
    pose_ = fix->pose;
  }
}

void EventWriter::write_drive(Time now, const DriveState& drive) {
  ros_.write_applied(now, drive.applied);
  const bool is_news =
      !verdict_ || verdict_->motion != drive.verdict.motion || verdict_->reason != drive.verdict.reason;
  if (!verdict_ || verdict_->motion != drive.verdict.motion)
    ros_.write_log(now, log_line(drive.time, drive.verdict), "drive");
  if (is_news) {
    const DiagnosticStatus status[] = {status_of(drive.verdict)};
    ros_.write_diagnostics(now, status);
  }
  verdict_ = drive.verdict;
  const bool changed =
      !battery_ || battery_->level != drive.battery.level || battery_->brownout != drive.battery.brownout;
  if (changed || now >= battery_due_) {
    ros_.write_battery(now, drive.battery);
    battery_due_ = now + kBatteryEvery;
  }
  battery_ = drive.battery;
}

void EventWriter::look(Time now) {
  while (const auto line = ports_.log.try_pop()) ros_.write_log(now, *line, "dynslam");
  const bool is_due = now >= health_due_;
  if (is_due) {
    health_due_ = now + kHealthEvery;
    write_health(now);
  }
  write_autopilot(now, is_due);
  if (now >= map_due_) {
    map_due_ = now + kMapEvery;
    write_map(now);
  }
}

void EventWriter::write_health(Time now) {
  std::vector<DiagnosticStatus> all;
  for (const auto& [name, health] : ports_.device_healths()) {
    const auto now_known = health->get().value;
    if (!now_known || !now_known->present) continue;
    all.push_back(status_of(name, *now_known, now));
    const bool rests = health == &ports_.camera_health && ports_.watchers == 0;
    if (rests && all.back().level == Level::kStale) {
      all.back().level = Level::kOk;
      all.back().message = "rests";
    }
  }
  if (verdict_) {
    all.push_back(status_of(*verdict_));
    all.back().values.emplace_back("power_limit", shortest_text(ports_.power_limit));
  }
  if (pose_) all.push_back(status_of(*pose_));
  if (const auto recording = ports_.recording.get().value) {
    const Level level = recording->dropped > 0 ? Level::kWarn : Level::kOk;
    all.push_back({level, "recorder", "records", {{"dropped", std::to_string(recording->dropped)}}});
  }
  ros_.write_diagnostics(now, all);
}

void EventWriter::write_autopilot(Time now, bool is_due) {
  const auto status = ports_.autopilot.get().value;
  if (!status) return;
  const std::string about = in_words(*status);
  const bool is_on = !about.empty();
  const bool is_another = std::exchange(autopilot_about_, about) != about;
  // A reason may name a distance, which changes all the time.
  if (is_another || (is_due && is_on && autopilot_reason_ != status->reason)) {
    autopilot_reason_ = status->reason;
    const LogLevel level = status->phase == AutopilotPhase::kStopped ? LogLevel::kWarn : LogLevel::kInfo;
    const std::string why = status->reason.empty() ? "" : ": " + status->reason;
    ros_.write_log(now, {status->time, level, is_on ? about + why : "is off"}, "autopilot");
  }
  if (is_due && is_on) ros_.write_route(now, status->route_map);
  if (is_another && !is_on) ros_.write_route(now, {});
}

/// Only when a cell has changed since the last one.
void EventWriter::write_map(Time now) {
  const auto world = ports_.world.get().value;
  if (!world) return;
  TrinaryMap map = trinary_map(world->map);
  while (map.cells.size() > kMostMapCells) map = coarser(map);
  const std::size_t hash = hash_of(map);
  if (map.cells.empty() || std::exchange(map_hash_, hash) == hash) return;
  ros_.write_map(now, world->pose.stamp, map);
}

}  // namespace dynslam
