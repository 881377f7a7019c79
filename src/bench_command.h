// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "config.h"

namespace dynslam {

struct BenchOptions {
  std::string world = "apartment";
  std::uint64_t seed = 1;
  double duration_s = 60.0;  ///< of simulated time
};

/// `dynslam bench`: what the robot's thinking costs on this computer. A robot explores a simulated world step
/// by step, with one client who watches; CPU time is measured apart for each kind of work, without what the
/// simulator takes. Prints a table, and a line to send. Returns the exit code. Throws InputError for what
/// cannot be used.
int run_bench(const BenchOptions& options, const Config& config);

}  // namespace dynslam
