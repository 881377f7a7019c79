// SPDX-License-Identifier: MIT
// Whether SLAM is robust or lucky: replays jittered copies of a recording and says how far their errors
// spread.
//
//   cmake --preset release && cmake --build --preset release --target dynslam_jitter
//   build/release/tests/tools/jitter/dynslam_jitter RECORDING REFERENCE.tum
//
// Exit code 0: the worst copy is near the median, final and live; 1: it is not, or the work failed; 2: usage
// or unreadable input.
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "config.h"
#include "io/safe_file.h"
#include "tools/jitter/jitter_runs.h"
#include "tools/jitter/spread.h"
#include "tools/jitter/tum_file.h"

namespace dynslam::jitter {
namespace {

constexpr int kFailed = 1;
constexpr int kUnusable = 2;

struct Options {
  std::string recording, reference;
  std::optional<std::string> config, keep;
  std::vector<std::string> settings;
  JitterPlan plan;
  Tolerance tolerance;
};

void add_jitter_options(CLI::App& app, JitterConfig& jitter) {
  app.add_option("--drop", jitter.drop_share, "share of the scans to drop by chance")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--odometry-noise", jitter.odometry_noise,
                 "deviation of each step's way and turn, as a share")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--cut-s", jitter.cut_s, "seconds to cut off, counted from the first scan")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  app.add_flag("!--keep-odometry-origin", jitter.move_odometry, "do not move the odometry's origin");
  app.add_flag("!--keep-imu-heading", jitter.turn_imu, "do not turn the IMU's heading");
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("recording", options.recording, "CARMEN log or MCAP file")->required();
  app.add_option("reference", options.reference, "where the robot was: t x y z qx qy qz qw a line")
      ->required();
  app.add_option("--config", options.config, "configuration file (TOML)")->type_name("FILE");
  app.add_option("--set", options.settings, "one setting, over what the file says: section.key=value")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--keep", options.keep, "folder for the copies' trajectories, for those who look closer")
      ->type_name("DIR");
  app.add_option("--copies", options.plan.copies, "jittered copies to replay")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--seed", options.plan.seed, "of the first copy")->capture_default_str();
  app.add_option("--jobs", options.plan.jobs, "threads")->check(CLI::Range(1, 1024))->capture_default_str();
  app.add_option("--worst-factor", options.tolerance.factor, "the worst may be so many times the median")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--worst-margin-m", options.tolerance.margin_m, "or so many metres above it")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  add_jitter_options(app, options.plan.jitter);
}

void keep_trajectories(const std::vector<CopyResult>& results, const std::string& folder) {
  OutputFolder out(folder);
  for (const CopyResult& copy : results)
    out.stage("copy-" + std::to_string(copy.seed.value_or(0)) + ".tum", to_tum(copy.trajectory));
  out.commit();
}

void print_copy(const CopyResult& copy) {
  const std::string name = copy.seed ? std::to_string(*copy.seed) : "as recorded";
  std::printf("%-11s %6zu %11.4f %10.4f %8llu\n", name.c_str(), copy.scans, copy.final_m, copy.live_m,
              static_cast<unsigned long long>(copy.closures));
  std::fflush(stdout);
}

/// One line: how far the errors of the copies spread; returns whether that is narrow.
bool print_spread(const char* name, const std::vector<CopyResult>& results, double CopyResult::*error_m,
                  const Tolerance& tolerance) {
  std::vector<double> errors;
  for (const CopyResult& copy : results) {
    if (copy.seed) errors.push_back(copy.*error_m);
  }
  const Spread spread = spread_of(std::move(errors));
  const bool narrow = is_narrow(spread, tolerance);
  std::printf("%-5s min %.4f  median %.4f  mean %.4f  max %.4f m: %s\n", name, spread.min, spread.median,
              spread.mean, spread.max, narrow ? "narrow" : "too wide");
  return narrow;
}

int run(int argc, char** argv) {
  CLI::App app("dynslam_jitter: how far the error spreads over jittered copies of a recording");
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : kUnusable;
  }
  const Config config = make_config(options.config, options.settings);
  options.plan.slam = config.slam;
  FileSource reference_file(options.reference);
  const std::vector<StampedPose> reference = read_tum(reference_file);
  const RecordingConfig recording_config{.lidar_mount = config.lidar.mount()};
  const auto open = [&] { return open_recording(options.recording, recording_config); };

  std::printf("%-11s %6s %11s %10s %8s\n", "seed", "scans", "ATE final m", "ATE live m", "closures");
  const std::vector<CopyResult> results = run_copies(open, reference, options.plan, print_copy);
  if (options.keep) keep_trajectories(results, *options.keep);
  const bool narrow_final = print_spread("final", results, &CopyResult::final_m, options.tolerance);
  const bool narrow_live = print_spread("live", results, &CopyResult::live_m, options.tolerance);
  return narrow_final && narrow_live ? 0 : kFailed;
}

}  // namespace
}  // namespace dynslam::jitter

int main(int argc, char** argv) {
  try {
    return dynslam::jitter::run(argc, argv);
  } catch (const dynslam::InputError& e) {
    std::fprintf(stderr, "dynslam_jitter: %s\n", e.what());
    return dynslam::jitter::kUnusable;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dynslam_jitter: failed: %s\n", e.what());
    return dynslam::jitter::kFailed;
  }
}
