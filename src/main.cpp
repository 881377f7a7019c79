// SPDX-License-Identifier: MIT
// The command line. Exit code 0: fine, 1: the work failed, 2: usage or unreadable input.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "bench_command.h"
#include "config.h"
#include "probe_command.h"
#include "replay_command.h"
#include "run_command.h"
#include "sim_command.h"

namespace {

constexpr int kFailed = 1;
constexpr int kUnusable = 2;

/// The options that every command takes.
struct Common {
  std::optional<std::string> config;
  std::vector<std::string> settings;

  void add_to(CLI::App& command, const std::string& file_option) {
    command.add_option(file_option, config, "configuration file (TOML)")->type_name("FILE");
    command.add_option("--set", settings, "one setting, over what the file says: section.key=value")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
  }
  dynslam::Config load() const {
    dynslam::Config read = dynslam::make_config(config, settings);
    for (const std::string& warning : read.warnings) spdlog::warn("{}", warning);
    return read;
  }
};

int run(int argc, char** argv) {
  CLI::App app("dynslam: a map of the building a robot is in, made and kept on the robot");
  app.set_version_flag("--version", "dynslam " DYNSLAM_VERSION);
  app.require_subcommand(1);
  Common common;

  dynslam::ReplayOptions options;
  CLI::App* replay = app.add_subcommand(
      "replay", "map a recording: CARMEN log (.clf, .log, .gz) or MCAP with ROS 2 messages");
  replay->add_option("recording", options.recording, "the recording")->required()->type_name("RECORDING");
  replay->add_option("--out", options.out, "folder for map, trajectory and report")
      ->type_name("DIR")
      ->capture_default_str();
  replay->add_option("--frames", options.frames, "also a picture of the map after every N scans")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000000));
  replay->add_flag("--quiet", options.quiet, "no progress and no summary");
  common.add_to(*replay, "--config");

  dynslam::SimOptions sim_options;
  CLI::App* sim = app.add_subcommand("sim", "the whole robot, only its hardware is simulated");
  sim->add_option("--world", sim_options.world,
                  "a world that comes with dynslam (apartment, office, clutter, warehouse, empty), or a file")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  sim->add_option("--speed", sim_options.speed,
                  "times as fast as life; 0: step by step, as fast as it goes, the same every time")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  sim->add_option("--seed", sim_options.seed, "of the noise of everything")
      ->check(CLI::Range(0, 1000000000))
      ->capture_default_str();
  sim->add_option("--out", sim_options.out, "folder for map, trajectory, truth and report")->type_name("DIR");
  sim->add_flag("--headless", sim_options.headless, "serve nobody; goes on a tour");
  sim->add_option("--duration", sim_options.duration_s, "most of simulated time, in seconds")
      ->type_name("S")
      ->check(CLI::Range(0.1, 1e6));
  sim->add_option("--mission", sim_options.mission,
                  "what to do by itself: tour, explore, or goals:N, to explore and then drive to N places "
                  "drawn by lot")
      ->type_name("NAME");
  sim->add_option("--port", sim_options.port,
                  "where to serve, in place of server.port; 0: any port that is free")
      ->type_name("N")
      ->check(CLI::Range(0, 65535));
  sim->add_option("--laps", sim_options.laps, "how often to drive the tour")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  sim->add_option("--fault", sim_options.faults,
                  "a device that fails, from when to when in seconds: lidar:unplugged:10:15")
      ->type_name("DEVICE:KIND:FROM[:UNTIL]")
      ->allow_extra_args(false);
  sim->add_option("--kick", sim_options.kicks,
                  "somebody carries the robot off, as seen from it in metres and degrees: 30:1:0:90")
      ->type_name("AT:FORWARD:LEFT[:TURN]")
      ->allow_extra_args(false);
  common.add_to(*sim, "--config");

  CLI::App* robot = app.add_subcommand("run", "the robot, on its own hardware");
  common.add_to(*robot, "--config");

  dynslam::ProbeOptions probe_options;
  CLI::App* probe = app.add_subcommand("probe", "what hardware is there, and what to do about it");
  probe->add_flag("--spin-motors", probe_options.spin_motors, "turn the wheels a little, after asking");
  common.add_to(*probe, "--config");

  dynslam::BenchOptions bench_options;
  CLI::App* bench = app.add_subcommand("bench", "what the robot's work costs on this computer");
  bench->add_option("--world", bench_options.world, "where the simulated robot drives, as for sim")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  bench->add_option("--seed", bench_options.seed, "of the noise of everything")
      ->check(CLI::Range(0, 1000000000))
      ->capture_default_str();
  bench->add_option("--duration", bench_options.duration_s, "of simulated time, in seconds")
      ->type_name("S")
      ->check(CLI::Range(0.1, 1e5))
      ->capture_default_str();
  common.add_to(*bench, "--config");

  CLI::App* check = app.add_subcommand(
      "check-config", "read a configuration file and print all settings as they are in force");
  common.add_to(*check, "file");
  check->get_option("file")->required();

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    spdlog::error("{} (--help says more)", e.what());
    return kUnusable;
  }
  if (check->parsed()) {
    std::fputs(config_reference(common.load()).c_str(), stdout);
    return 0;
  }
  if (robot->parsed()) return dynslam::run_robot(dynslam::make_config(common.config, common.settings));
  if (probe->parsed()) return dynslam::run_probe(probe_options, common.load(), std::cin, std::cout);
  if (bench->parsed()) return dynslam::run_bench(bench_options, common.load());
  if (sim->parsed()) return dynslam::run_sim(sim_options, common.load());
  return dynslam::run_replay(options, common.load());
}

}  // namespace

int main(int argc, char** argv) {
  setenv("LIBCAMERA_LOG_LEVELS", "*:ERROR", 0);  // it writes to stderr by itself
  spdlog::set_default_logger(spdlog::stderr_color_mt("dynslam"));
  spdlog::set_pattern("%n: %^%v%$");
  try {
    const int code = run(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      throw std::runtime_error("cannot write to standard output");
    return code;
  } catch (const dynslam::InputError& e) {
    spdlog::error("{}", e.what());
    return kUnusable;
  } catch (const std::exception& e) {
    spdlog::critical("failed: {}", e.what());
    return kFailed;
  }
}
