// SPDX-License-Identifier: MIT
// Whether memory and time depend on the building and not on the hours: takes SLAM through the same recording
// lap after lap and says what each lap cost. The recording should end near where it began.
//
//   build/release/tests/tools/growth/dynslam_growth RECORDING [--laps 10] [--path 3000] [--set
//   section.key=value]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <malloc.h>
#include <unistd.h>

#include "config.h"
#include "io/recording.h"
#include "robot/steady_memory.h"
#include "slam/slam.h"

namespace dynslam::growth {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begun) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

/// Resident memory now, from the kernel; 0 where it does not say.
double resident_mb() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// What is allocated and not given back: memory less what the allocator keeps for later.
double in_use_mb() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1e6;
}

/// Sums over the stages that Slam enters, so that what finished maps cost is told apart.
class StageSums : public StageWatch {
 public:
  void enter(std::string_view stage) override {
    if (stage_ == "close loops") {
      closing_ms += ms_since(since_);
      most_closing_ms = std::max(most_closing_ms, ms_since(since_));
    }
    if (!stage_.empty()) all_ms += ms_since(since_);
    stage_ = stage;
    since_ = Clock::now();
  }
  double all_ms = 0.0, closing_ms = 0.0, most_closing_ms = 0.0;

 private:
  std::string_view stage_;
  Clock::time_point since_;
};

Time stamp_of(const Record& record) {
  return std::visit([](const auto& sample) { return sample.stamp; }, record);
}

void add_later(Slam& slam, Record record, Duration by) {
  std::visit(
      [&](auto& sample) {
        sample.stamp += by;
        slam.add(std::move(sample));
      },
      record);
}

void print_lap(int lap, std::size_t scans, std::size_t maps, const StageSums& sums, const Slam& slam) {
  const auto n = static_cast<double>(std::max<std::size_t>(1, scans));
  std::printf("%4d %7zu %9zu %7zu %7zu %8zu %9.3f %9.2f %9.2f %8.1f %8.1f\n", lap, scans,
              slam.local_maps_begun(), slam.local_maps_active(), slam.back_end().global_map().blocks(),
              slam.back_end().global_map().names(), (sums.all_ms - sums.closing_ms) / n,
              sums.closing_ms / static_cast<double>(std::max<std::size_t>(1, maps)), sums.most_closing_ms,
              in_use_mb(), resident_mb());
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  CLI::App app("dynslam_growth: what each lap of the same recording costs");
  std::string path;
  int laps = 10;
  std::size_t path_scans = 3000;
  std::vector<std::string> settings;
  app.add_option("recording", path, "CARMEN log or MCAP file that ends near where it began")->required();
  app.add_option("--laps", laps, "how often")->check(CLI::Range(1, 10000))->capture_default_str();
  app.add_option("--path", path_scans, "of so many scans it stays known where they were taken")
      ->check(CLI::Range(1, 1000000000))
      ->capture_default_str();
  app.add_option("--set", settings, "one setting: section.key=value")->allow_extra_args(false);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  const Config config = make_config(std::nullopt, settings);
  StageSums sums;
  keep_memory_steady();
  Slam slam(config.slam, &sums);
  slam.keep_path(path_scans);
  std::printf("%4s %7s %9s %7s %7s %8s %9s %9s %9s %8s %8s\n", "lap", "scans", "maps", "active", "blocks",
              "names", "ms/scan", "ms/map", "most ms", "used MB", "MB");
  Duration shift{};
  for (int lap = 1; lap <= laps; ++lap) {
    const auto recording = open_recording(path, {.lidar_mount = config.lidar.mount()});
    std::size_t scans = 0;
    const std::size_t maps_before = slam.local_maps_begun();
    sums.all_ms = sums.closing_ms = sums.most_closing_ms = 0.0;
    std::optional<Time> first;
    Time last;
    while (auto record = recording->next()) {
      const Time stamp = stamp_of(*record);
      if (!first) first = stamp;
      last = std::max(last, stamp);
      add_later(slam, std::move(*record), shift);
      while (slam.next()) ++scans;
    }
    if (first) shift += last - *first + std::chrono::seconds(1);
    print_lap(lap, scans, slam.local_maps_begun() - maps_before, sums, slam);
  }
  return 0;
}

}  // namespace
}  // namespace dynslam::growth

int main(int argc, char** argv) {
  try {
    return dynslam::growth::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dynslam_growth: %s\n", e.what());
    return 2;
  }
}
