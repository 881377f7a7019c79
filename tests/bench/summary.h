// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "bench/growth_plot.h"
#include "bench/run_table.h"

namespace dynslam::bench {

/// Prints what one run compares: ratios, which hold on any machine, where times do not. What did not run
/// is nan.
void print_summary(const RunTable& runs);

/// What the work on a finished local map costs by the number of those there are; what did not run is left
/// out.
std::vector<GrowthSeries> growth_of(const RunTable& runs);

}  // namespace dynslam::bench
