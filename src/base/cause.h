// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace dynslam {

/// The rows of Safety's table, first in rank where two say equally bad.
enum class Cause : std::uint8_t {
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
  kTouch,   ///< a bumper is pressed, and the robot drives on
  kObstacle,
  kImu,  ///< was there and is silent or frozen: tilt is not watched
  kBrownout,
  kBattery,  ///< nearly empty
};

/// One word, as it is told to others.
constexpr const char* to_string(Cause cause) {
  constexpr const char* kWords[] = {"none",     "clock",       "e-stop",   "stop",   "pins",   "motors",
                                    "failsafe", "motor-fault", "tilt",     "scan",   "driver", "touch",
                                    "obstacle", "imu",         "brownout", "battery"};
  return kWords[static_cast<int>(cause)];
}

}  // namespace dynslam
