// SPDX-License-Identifier: MIT
#pragma once

#include "base/time.h"
#include "base/verdict.h"

namespace dynslam {

/// Whether the status light is on at `t`: steady while the robot may go, short gaps when it is slowed down or
/// held, blinking once a second when it stands, and fast when a person has to clear an e-stop.
bool status_light(Motion motion, Time t);

}  // namespace dynslam
