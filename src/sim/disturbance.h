// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sim/world.h"

namespace dynslam {

/// Faults and kicks as they are written on the command line. Throw InputError.

/// "DEVICE:KIND:FROM[:UNTIL]", in seconds.
ScheduledFault parse_fault(const std::string& text);
/// "AT:FORWARD:LEFT[:TURN]", in seconds, metres and degrees, as seen from the robot.
ScheduledKick parse_kick(const std::string& text);

}  // namespace dynslam
