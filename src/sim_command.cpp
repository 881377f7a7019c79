// SPDX-License-Identifier: MIT
#include "sim_command.h"

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "errand_scripts.h"
#include "io/safe_file.h"
#include "log_tap.h"
#include "progress_bar.h"
#include "result_files.h"
#include "robot/stage_clock.h"
#include "robot/steady_memory.h"
#include "serve.h"
#include "sim/disturbance.h"
#include "sim_mission.h"
#include "tour_script.h"

namespace dynslam {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(10);

volatile std::sig_atomic_t stop_signal = 0;
void on_signal(int signal) { stop_signal = signal; }

/// The world, and what shall go wrong in it.
World world_of(const SimOptions& options) {
  World world = load_world(options.world);
  for (const std::string& fault : options.faults) world.faults.push_back(parse_fault(fault));
  for (const std::string& kick : options.kicks) world.kicks.push_back(parse_kick(kick));
  std::stable_sort(world.kicks.begin(), world.kicks.end(),
                   [](const ScheduledKick& a, const ScheduledKick& b) { return a.at_s < b.at_s; });
  return world;
}

/// What ends a mission from outside.
std::optional<MissionEnd> turn(SimMission& mission) {
  if (stop_signal != 0) return MissionEnd{"stopped", "asked to"};
  return mission.turn();
}

/// What became of the recording, where that is not what was wanted.
void warn_of_recording(const Ports& ports) {
  const auto recording = ports.recording.get().value;
  if (recording && !recording->trouble.empty())
    spdlog::warn("the recording is not whole: {}", recording->trouble);
}

constexpr const char* kNoMission = ": the missions are tour, explore, and goals:N with up to 10000 goals";

/// The N of goals:N.
std::size_t goals_of(const std::string& mission) {
  const std::string_view digits = std::string_view(mission).substr(std::string_view("goals:").size());
  std::size_t goals = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), goals);
  if (error != std::errc() || end != digits.data() + digits.size() || goals < 1 || goals > 10000)
    throw InputError("--mission " + mission + kNoMission);
  return goals;
}

/// What the robot is to do; `tour` when that is a tour, which has to yield to people.
std::unique_ptr<MissionScript> script_of(const SimOptions& options, const World& world, TourScript*& tour) {
  const std::string& mission = options.mission;
  if (mission.starts_with("goals:")) return std::make_unique<GoalsScript>(goals_of(mission), options.seed);
  if (mission == "explore") return std::make_unique<ExploreScript>();
  if (mission.empty() && !options.headless) return std::make_unique<WaitingScript>();
  if (!mission.empty() && mission != "tour") throw InputError("--mission " + mission + kNoMission);
  auto script = std::make_unique<TourScript>(world, options.laps);
  tour = script.get();
  return script;
}

/// All in this thread, as fast as it goes, repeatable to the bit.
MissionEnd run_stepped(SimMission& mission, SteppedClock& clock, ProgressBar& bar) {
  while (true) {
    clock.set(clock.now() + kStep);
    if (auto end = turn(mission)) return *end;
    mission.robot().step();
    bar.show(mission.passed_s() / mission.limit_s(), mission.scans());
  }
}

/// With the robot's threads. Ends the program where one of them hangs.
MissionEnd run_live(SimMission& mission, const Clock& clock) {
  mission.robot().start();
  std::optional<MissionEnd> end;
  while (!end && !mission.robot().wait(clock.steady(mission.next_turn()))) end = turn(mission);
  const Robot::Ending ending = mission.robot().stop();
  if (ending.hangs) {
    spdlog::critical("a device does not come back; the motors are off");
    std::_Exit(1);
  }
  if (!ending.trouble.empty()) return {"stopped", ending.trouble};
  return end.value_or(MissionEnd{"stopped", "asked to"});
}

void tell(const SimOptions& options, const nlohmann::json& figures, const SimMission& mission) {
  const MappingResult& result = mission.result;
  std::printf(
      "%s: mission %s after %.0f s (%s), %.1f m driven, %d contacts, mapped from %zu scans in %.2f s\n",
      options.world.c_str(), figures["result"].get<std::string>().c_str(), figures["time_s"].get<double>(),
      figures["reason"].get<std::string>().c_str(), figures["distance_m"].get<double>(),
      figures["contacts"].get<int>(), mission.scans(), result.wall_s);
  for (const auto& [name, n] : result.counters)
    std::printf("  %s: %llu\n", name.c_str(), static_cast<unsigned long long>(n));
  if (options.out) std::printf("map picture: %s/map.png\n", options.out->c_str());
}

}  // namespace

int run_sim(const SimOptions& options, const Config& config) {
  keep_memory_steady();  // a robot runs for months; a replay is better off with memory that it need not ask
                         // for again
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
  const World world = world_of(options);
  TourScript* tour = nullptr;
  auto script = script_of(options, world, tour);
  Config own = config;
  if (!options.mission.empty() && !tour) own.autopilot.when_explored = "stay";  // or it would never end
  SimMission mission({world, options.seed, options.duration_s, options.out.has_value()}, std::move(script),
                     own, *clock);
  const LogTap tap(mission.robot().ports(), *clock);
  if (out) mission.robot().ports().recording_wish.put({true, out->reserve("recording.mcap")});
  std::optional<Serving> serving;
  if (!options.headless) {
    if (stepped) throw InputError("--speed 0 knows no time in which to serve: it goes with --headless");
    ServeOptions serve{options.port, options.world};
    serve.drives_itself = [tour] { return tour != nullptr; };
    serving.emplace(mission.robot().ports(), *clock, own, serve);
    if (tour) tour->yield_to([&serving] { return serving && serving->is_steered(); });
  }
  MissionEnd end;
  if (stepped) {
    ProgressBar bar(options.duration_s.has_value());
    end = run_stepped(mission, *stepped, bar);
  } else {
    end = run_live(mission, *clock);
  }
  serving.reset();
  const nlohmann::json figures = mission.finish(end);
  mission.result.wall_s = timer.wall_s();
  mission.result.cpu_s = timer.cpu_s();
  tell(options, figures, mission);
  for (const std::string& finding : mission.result.findings) spdlog::warn("{}", finding);
  warn_of_recording(mission.robot().ports());
  if (out) {
    nlohmann::json report = report_of(mission.result);
    report["mission"] = figures;
    out->stage("truth.tum", to_tum(mission.truth_map()));
    out->stage("world.svg", to_svg(mission.simulator().world()));
    stage_results(*out, mission.result, report);
    out->commit();
  }
  return end.result == "stopped" && stop_signal == 0 ? 1 : 0;
}

}  // namespace dynslam
