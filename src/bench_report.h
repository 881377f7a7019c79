// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "machine.h"
#include "work_meter.h"

namespace dynslam {

/// What a simulated drive cost on a machine.
struct BenchFigures {
  std::string version, world;
  std::uint64_t seed = 1;
  Machine machine;
  double drive_s = 0.0;  ///< simulated time
  double driven_m = 0.0;
  std::size_t scans = 0;
  WorkCosts costs = {};
  double simulator_s = 0.0;      ///< CPU time of what is not counted
  std::size_t client_bytes = 0;  ///< that a client was sent
  long peak_rss_bytes = 0;       ///< of the process, the simulator in it

  const WorkCost& cost(Work work) const { return costs[static_cast<std::size_t>(work)]; }
  WorkCost& cost(Work work) { return costs[static_cast<std::size_t>(work)]; }
};

/// A lidar that turns fast, and a camera that somebody watches.
inline constexpr double kBenchScansASecond = 12.5, kBenchPicturesASecond = 20.0;

/// Which share of one core a work takes in life: 1 is all of it.
double share_of_core(const BenchFigures& figures, Work work);
/// All works together but the pictures, which nobody makes unless somebody watches.
double share_of_core(const BenchFigures& figures);

/// For people.
std::string bench_table(const BenchFigures& figures);
/// The same in one line, to be sent: `dynslam-bench: version=0.1.0 model="..." ...`.
std::string bench_line(const BenchFigures& figures);

}  // namespace dynslam
