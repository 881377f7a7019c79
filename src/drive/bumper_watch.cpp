// SPDX-License-Identifier: MIT
#include "drive/bumper_watch.h"

namespace dynslam {
namespace {

bool drives_on(const Twist& into, const Twist& wanted) {
  if (into.v_mps != 0.0) return is_moving(wanted) && wanted.v_mps * into.v_mps >= 0.0;
  return wanted.w_radps * into.w_radps > 0.0;
}

}  // namespace

Finding BumperWatch::update(Time now, const std::optional<Stamped<PinState>>& pins, const Twist& driven,
                            const Twist& wanted) {
  const bool is_pressed = pins && now - pins->stamp <= timeout_ && pins->value.bumper_pressed.value_or(false);
  if (!is_pressed) {
    into_.reset();
    return {};
  }
  if (!into_) into_ = is_moving(driven) ? driven : Twist{1.0, 0.0};
  if (!drives_on(*into_, wanted)) return {};
  return {Cause::kTouch, {Motion::kHold, "touching something: drive the other way"}};
}

}  // namespace dynslam
