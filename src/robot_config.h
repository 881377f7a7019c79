// SPDX-License-Identifier: MIT
#pragma once

#include "config.h"
#include "robot/robot.h"

namespace dynslam {

/// What of the configuration a robot needs, and what its recordings say of it.
RobotConfig robot_config(const Config& config);

}  // namespace dynslam
