// SPDX-License-Identifier: MIT
#pragma once

#include "config.h"

namespace dynslam {

/// The robot, on its own hardware, until SIGTERM, SIGINT or SIGHUP. Returns the exit code. Throws what stops
/// its start.
int run_robot(const Config& config);

}  // namespace dynslam
