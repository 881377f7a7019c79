// SPDX-License-Identifier: MIT
// The benchmarks of what costs: drawing scans, matching them, work on whole maps, whole recordings, ticks of
// driving, planning, turns of exploring, the simulator, and decoding what a lidar sends.
//
//   cmake --preset release && cmake --build --preset release --target dynslam_bench
//   build/release/tests/bench/dynslam_bench
//
// --benchmark_filter=clear runs some of them. On a busy machine
//   --benchmark_repetitions=5 --benchmark_report_aggregates_only --benchmark_enable_random_interleaving
// makes the closing summary steady: it takes the medians.
//
// No time is asserted anywhere. Times depend on the machine and on what else it does; the ratios of the
// summary come from one run, in CPU time, and compare one thing with another on the same machine.
//
// Names say what is measured, on which scans, at which cell size:
//   csail_361_real    a real recording, tests/data/mit-csail.clf.gz: half a turn, 361 beams
//   room_1200_drawn   made: a furnished room of 12 x 9 m, drawn, with noise: a full turn of 1200 beams
//   anything else     the recording that the environment variable DYNSLAM_BENCH_RECORDING names, in place of
//   the room
//
// With DYNSLAM_BENCH_GROWTH=FILE.svg, how the work on a finished local map grows with those there are is
// drawn, too:
//
//   DYNSLAM_BENCH_GROWTH=growth.svg build/release/tests/bench/dynslam_bench
//       --benchmark_filter='clean_up|loop_search|solve|redraw'
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "base/error.h"
#include "bench/benchmarks.h"
#include "bench/growth_plot.h"
#include "bench/run_table.h"
#include "bench/summary.h"

namespace dynslam::bench {
namespace {

/// Prints as usual, and keeps the figures for the summary.
class KeepingReporter : public benchmark::ConsoleReporter {
 public:
  KeepingReporter() : ConsoleReporter(isatty(STDOUT_FILENO) ? OO_ColorTabular : OO_Tabular) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      // The median comes too where only aggregates are asked for; among single runs it is in the middle
      // anyway.
      if (run.run_type != Run::RT_Iteration && run.aggregate_name != "median") continue;
      const std::string& size = run.run_name.args;
      const std::string benchmark = run.run_name.function_name + (size.empty() ? "" : "/" + size);
      kept_.add(benchmark, "cpu_s",
                run.GetAdjustedCPUTime() / benchmark::GetTimeUnitMultiplier(run.time_unit));
      for (const auto& [name, counter] : run.counters) kept_.add(benchmark, name, counter.value);
    }
  }
  const RunTable& kept() const { return kept_; }

 private:
  RunTable kept_;
};

/// In a process that never had a second thread libstdc++ counts the owners of chunks without atomics. The
/// robot has threads.
void have_had_a_thread() {
  std::thread([] {}).join();
}

int run(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  register_memory_benchmarks();
  register_clear_benchmarks();
  register_match_benchmarks();
  register_replay_benchmarks();
  register_back_end_benchmarks();
  register_map_benchmarks();
  register_drive_benchmarks();
  register_plan_benchmarks();
  register_autopilot_benchmarks();
  register_cast_benchmarks();
  register_rplidar_benchmarks();
  have_had_a_thread();
  KeepingReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  print_summary(reporter.kept());
  if (const char* file = std::getenv("DYNSLAM_BENCH_GROWTH")) {
    std::ofstream(file) << growth_svg(growth_of(reporter.kept()));
  }
  return 0;
}

}  // namespace
}  // namespace dynslam::bench

int main(int argc, char** argv) {
  try {
    return dynslam::bench::run(argc, argv);
  } catch (const dynslam::InputError& e) {
    std::fprintf(stderr, "dynslam_bench: %s\n", e.what());
    return 2;
  }
}
