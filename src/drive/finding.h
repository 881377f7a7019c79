// SPDX-License-Identifier: MIT
#pragma once

#include "base/verdict.h"

namespace dynslam {

/// The rows of Safety's table, first in rank where two say equally bad.
enum class Cause {
  kNone,
  kClock,       ///< ran backwards
  kEStopPin,    ///< pressed; latched
  kStopAsked,   ///< by a person or by a part of the program; latched
  kPinsSilent,  ///< the e-stop was read before and is not any more
  kMotorsSilent,
  kFailsafeOff,  ///< of the motor board
  kMotorFault,
  kTilt,
  kScan,    ///< missing, too old, frozen or blind
  kDriver,  ///< heartbeat lost, or no new command since
  kObstacle,
  kImu,  ///< was there and is silent or frozen: tilt is not watched
  kBrownout,
  kBattery,  ///< nearly empty
};

/// What one row says: how bad it is, and why in words.
struct Finding {
  Cause cause = Cause::kNone;
  Verdict verdict{Motion::kGo, {}};
};

}  // namespace dynslam
