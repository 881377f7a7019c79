// SPDX-License-Identifier: MIT
#include "drive/speed_ramp.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr Duration kLongestStep = std::chrono::milliseconds(100);

bool is_speeding_up(double from, double to) { return from * to >= 0.0 && std::abs(to) > std::abs(from); }

/// Slows down to `to`, or to zero when it lies beyond.
double slowed(double from, double to, double step) {
  const double end = from * to > 0.0 ? to : 0.0;
  return from > end ? std::max(end, from - step) : std::min(end, from + step);
}

}  // namespace

Twist SpeedRamp::toward(const Twist& target, Duration passed) const {
  const double s = to_seconds(std::clamp(passed, Duration(0), kLongestStep));
  const bool v_up = is_speeding_up(now_.v_mps, target.v_mps);
  const bool w_up = is_speeding_up(now_.w_radps, target.w_radps);
  const double dv = target.v_mps - now_.v_mps, dw = target.w_radps - now_.w_radps;
  double v_share = v_up ? std::min(1.0, config_.acceleration_mps2 * s / std::abs(dv)) : 1.0;
  double w_share = w_up ? std::min(1.0, config_.turn_acceleration_radps2 * s / std::abs(dw)) : 1.0;
  if (v_up && w_up) v_share = w_share = std::min(v_share, w_share);
  return {v_up ? now_.v_mps + v_share * dv : slowed(now_.v_mps, target.v_mps, config_.braking_mps2 * s),
          w_up ? now_.w_radps + w_share * dw
               : slowed(now_.w_radps, target.w_radps, config_.turn_braking_radps2 * s)};
}

}  // namespace dynslam
