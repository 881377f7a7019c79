// SPDX-License-Identifier: MIT
#pragma once

namespace dynslam::bench {

void register_memory_benchmarks();

}  // namespace dynslam::bench
