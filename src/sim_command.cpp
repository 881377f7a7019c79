// SPDX-License-Identifier: MIT
#include "sim_command.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "grid/trinary_map.h"
#include "io/safe_file.h"
#include "log_tap.h"
#include "progress_bar.h"
#include "result_files.h"
#include "robot/robot.h"
#include "robot/stage_clock.h"
#include "robot/steady_memory.h"
#include "robot/tour.h"
#include "robot_config.h"
#include "sim/simulator.h"

namespace dynslam {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(10);
constexpr Duration kCommandEvery = std::chrono::milliseconds(50);
constexpr Duration kFetchTruthEvery = std::chrono::seconds(60);

volatile std::sig_atomic_t stop_signal = 0;
void on_signal(int signal) { stop_signal = signal; }

/// What became of a mission, as report.json says it.
struct MissionEnd {
  std::string result, reason;
};

/// A simulated robot on a tour of its world, and what is noted on the way.
class TourMission {
 public:
  TourMission(const SimOptions& options, const Config& config, const Clock& clock)
      : options_(options),
        clock_(clock),
        begin_(clock.now()),
        simulator_(std::make_shared<Simulator>(load_world(options.world), clock, options.seed)),
        robot_(make_devices(simulator_), robot_config(config), clock),
        tour_(points_map(simulator_->world())) {
    robot_.on_scan([this](const ScanResult& scan) {
      result.trajectory_live.push_back({scan.stamp, scan.map_T_robot});
      result.inserted += scan.inserted ? 1 : 0;
    });
  }

  Robot& robot() { return robot_; }
  double passed_s() const { return to_seconds(clock_.now() - begin_); }
  double limit_s() const { return options_.duration_s.value_or(kLongest_s); }
  Time next_command() const { return next_command_; }

  /// Says what to drive, when that is due; returns how the mission ended, once it has.
  std::optional<MissionEnd> turn() {
    const Time now = clock_.now();
    if (now >= next_truth_) fetch_truth(now);
    if (stop_signal != 0) return MissionEnd{"stopped", "asked to"};
    if (passed_s() >= limit_s()) return MissionEnd{"timeout", "the time is up"};
    if (tour_.done()) return MissionEnd{"done", skipped_text()};
    if (now < next_command_) return std::nullopt;
    next_command_ = now + kCommandEvery;
    const auto world = robot_.ports().world.get().value;
    const auto drive = robot_.ports().drive.get().value;
    const Twist twist = world && drive ? tour_.next(now, world->pose, drive->verdict) : Twist{};
    robot_.ports().command.put({++seq_, twist, now});
    return std::nullopt;
  }

  /// REQUIRES: the robot stopped.
  nlohmann::json finish(const MissionEnd& end) {
    fetch_truth(clock_.now());
    robot_.finish();
    take_result(robot_.slam(), result);
    result.counters = robot_.counters();
    const SimTruth truth = simulator_->truth();
    nlohmann::json verdicts = nlohmann::json::array();
    for (const DriveControl::Transition& t : robot_.control().transitions())
      verdicts.push_back({{"time_s", to_seconds(t.time - begin_)},
                          {"motion", to_string(t.verdict.motion)},
                          {"reason", t.verdict.reason}});
    return {{"result", end.result},
            {"reason", end.reason},
            {"time_s", passed_s()},
            {"distance_m", truth.distance_m},
            {"contacts", truth.contacts},
            {"goals",
             {{"tried", tour_.reached() + tour_.skipped()},
              {"reached", tour_.reached()},
              {"failed", tour_.skipped()}}},
            {"verdicts", verdicts}};
  }

  /// In the frame that the robot's map has: its start.
  std::vector<StampedPose> truth_map() const {
    const Pose2 map_T_world = simulator_->world().world_T_start.inverse();
    std::vector<StampedPose> poses;
    for (const TruePose& p : truth_) poses.push_back({p.stamp, map_T_world * p.world_T_robot});
    return poses;
  }
  std::string world_svg() const { return to_svg(simulator_->world()); }

  MappingResult result;

 private:
  static constexpr double kLongest_s = 24 * 3600.0;

  static std::vector<Vector2> points_map(const World& world) {
    std::vector<Vector2> points;
    for (const Vector2& p : world.tour) points.push_back(world.world_T_start.inverse() * p);
    return points;
  }
  std::string skipped_text() const {
    return tour_.skipped() == 0 ? "all points reached"
                                : std::to_string(tour_.skipped()) + " points could not be reached";
  }
  void fetch_truth(Time now) {
    for (const TruePose& p : simulator_->truth_since(truth_.empty() ? begin_ - kStep : truth_.back().stamp))
      truth_.push_back(p);
    next_truth_ = now + kFetchTruthEvery;
  }

  const SimOptions& options_;
  const Clock& clock_;
  Time begin_, next_command_, next_truth_;
  std::shared_ptr<Simulator> simulator_;
  Robot robot_;
  Tour tour_;
  std::uint64_t seq_ = 0;
  std::vector<TruePose> truth_;
};

/// What became of the recording, where that is not what was wanted.
void warn_of_recording(const Ports& ports) {
  const auto recording = ports.recording.get().value;
  if (recording && !recording->trouble.empty())
    spdlog::warn("the recording is not whole: {}", recording->trouble);
}

/// All in this thread, as fast as it goes, repeatable to the bit.
MissionEnd run_stepped(TourMission& mission, SteppedClock& clock, ProgressBar& bar) {
  while (true) {
    clock.set(clock.now() + kStep);
    if (auto end = mission.turn()) return *end;
    mission.robot().step();
    bar.show(mission.passed_s() / mission.limit_s(), mission.result.trajectory_live.size());
  }
}

/// With the robot's threads. Ends the program where one of them hangs.
MissionEnd run_live(TourMission& mission, const Clock& clock) {
  mission.robot().start();
  std::optional<MissionEnd> end;
  while (!end && !mission.robot().wait(clock.steady(mission.next_command()))) end = mission.turn();
  const Robot::Ending ending = mission.robot().stop();
  if (ending.hangs) {
    spdlog::critical("a device does not come back; the motors are off");
    std::_Exit(1);
  }
  if (!ending.trouble.empty()) return {"stopped", ending.trouble};
  return end.value_or(MissionEnd{"stopped", "asked to"});
}

void tell(const SimOptions& options, const nlohmann::json& mission, const MappingResult& result) {
  std::printf(
      "%s: mission %s after %.0f s (%s), %.1f m driven, %d contacts, mapped from %zu scans in %.2f s\n",
      options.world.c_str(), mission["result"].get<std::string>().c_str(), mission["time_s"].get<double>(),
      mission["reason"].get<std::string>().c_str(), mission["distance_m"].get<double>(),
      mission["contacts"].get<int>(), result.trajectory.size(), result.wall_s);
  for (const auto& [name, n] : result.counters)
    std::printf("  %s: %llu\n", name.c_str(), static_cast<unsigned long long>(n));
  if (options.out) std::printf("map picture: %s/map.png\n", options.out->c_str());
}

}  // namespace

int run_sim(const SimOptions& options, const Config& config) {
  keep_memory_steady();  // a robot runs for months; a replay is better off with memory that it need not ask
                         // for again
  if (options.mission != "tour")
    throw InputError("--mission " + options.mission + ": there is only 'tour' so far");
  std::optional<OutputFolder> out;
  if (options.out) out.emplace(*options.out);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  const WorkTimer timer;
  std::unique_ptr<Clock> clock;
  SteppedClock* stepped = nullptr;
  if (options.speed > 0) {
    clock = std::make_unique<RunningClock>(Time(), options.speed);
  } else {
    auto steps = std::make_unique<SteppedClock>();
    stepped = steps.get();
    clock = std::move(steps);
  }
  TourMission mission(options, config, *clock);
  const LogTap tap(mission.robot().ports(), *clock);
  if (out) mission.robot().ports().recording_wish.put({true, out->reserve("recording.mcap")});
  MissionEnd end;
  if (stepped) {
    ProgressBar bar(options.duration_s.has_value());
    end = run_stepped(mission, *stepped, bar);
  } else {
    end = run_live(mission, *clock);
  }
  const nlohmann::json figures = mission.finish(end);
  mission.result.wall_s = timer.wall_s();
  mission.result.cpu_s = timer.cpu_s();
  tell(options, figures, mission.result);
  for (const std::string& finding : mission.result.findings) spdlog::warn("{}", finding);
  warn_of_recording(mission.robot().ports());
  if (out) {
    nlohmann::json report = report_of(mission.result);
    report["mission"] = figures;
    out->stage("truth.tum", to_tum(mission.truth_map()));
    out->stage("world.svg", mission.world_svg());
    stage_results(*out, mission.result, report);
    out->commit();
  }
  return end.result == "stopped" && stop_signal == 0 ? 1 : 0;
}

}  // namespace dynslam
