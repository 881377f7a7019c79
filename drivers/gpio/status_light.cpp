// SPDX-License-Identifier: MIT
#include "drivers/gpio/status_light.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;

/// On for the first `on` of each period.
bool blink(Time t, Duration period, Duration on) {
  const Duration phase = t.time_since_epoch() % period;
  return (phase < Duration(0) ? phase + period : phase) < on;
}

}  // namespace

bool status_light(Motion motion, Time t) {
  switch (motion) {
    case Motion::kGo:
      return true;
    case Motion::kSlow:
    case Motion::kHold:
      return blink(t, milliseconds(1000), milliseconds(800));
    case Motion::kStop:
      return blink(t, milliseconds(1000), milliseconds(500));
    case Motion::kEStop:
      break;
  }
  return blink(t, milliseconds(250), milliseconds(125));
}

}  // namespace dynslam
