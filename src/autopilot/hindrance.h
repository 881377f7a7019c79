// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/battery_state.h"
#include "base/cause.h"
#include "base/pose_estimate.h"
#include "base/verdict.h"

namespace dynslam {

/// How the robot is, as far as it keeps the autopilot from driving.
struct Condition {
  std::optional<PoseEstimate> pose;  ///< nothing: there is no map yet
  Verdict verdict{Motion::kGo, ""};
  Cause cause = Cause::kNone;  ///< of the verdict
  BatteryLevel battery = BatteryLevel::kUnknown;
  bool touches = false;  ///< a bumper is pressed
};

/// What keeps it from driving, and what to do about it.
struct Hindrance {
  enum class Remedy {
    kWait,       ///< it may pass
    kLookRound,  ///< turning shows where it is
    kGoHome,     ///< while it can
    kBackOff,    ///< it touched something
    kGiveUp,     ///< a person has to look
  };
  Remedy remedy = Remedy::kWait;
  std::string reason;
};

/// The gravest one; nothing when it can drive. That nobody drives, and what lies in the way, hinder a driver,
/// not the autopilot.
std::optional<Hindrance> hindrance_of(const Condition& condition);

}  // namespace dynslam
