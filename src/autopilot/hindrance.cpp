// SPDX-License-Identifier: MIT
#include "autopilot/hindrance.h"

namespace dynslam {

std::optional<Hindrance> hindrance_of(const Condition& c) {
  using Remedy = Hindrance::Remedy;
  if (c.verdict.motion == Motion::kEStop) return Hindrance{Remedy::kGiveUp, c.verdict.reason};
  if (c.verdict.motion == Motion::kStop && c.cause != Cause::kDriver) {
    const bool asked = c.cause == Cause::kStopAsked;
    return Hindrance{asked ? Remedy::kGiveUp : Remedy::kWait, c.verdict.reason};
  }
  if (c.touches) return Hindrance{Remedy::kBackOff, "it touched something"};
  if (!c.pose) return Hindrance{Remedy::kWait, "there is no map yet"};
  if (c.pose->lost) return Hindrance{Remedy::kLookRound, "it does not know where it is"};
  if (c.battery == BatteryLevel::kRecharge) return Hindrance{Remedy::kGoHome, "the battery is nearly empty"};
  return std::nullopt;
}

}  // namespace dynslam
