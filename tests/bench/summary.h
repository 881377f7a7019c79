// SPDX-License-Identifier: MIT
#pragma once

#include "bench/run_table.h"

namespace dynslam::bench {

/// Prints what one run compares: ratios, which hold on any machine, where times do not. What did not run
/// is nan.
void print_summary(const RunTable& runs);

}  // namespace dynslam::bench
