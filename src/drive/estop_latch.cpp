// SPDX-License-Identifier: MIT
#include "drive/estop_latch.h"

#include "drive/words.h"

namespace dynslam {

void EStopLatch::clock_went_back() {
  read_.reset();
  released_since_.reset();
}

void EStopLatch::take(const Stamped<PinState>& pins) {
  if (read_ && pins.stamp <= *read_) return;
  const bool gap = read_ && pins.stamp - *read_ > timeout_;
  read_ = pins.stamp;
  pressed_ = pins.value.estop_pressed;
  if (!pressed_ && (!released_since_ || gap)) released_since_ = pins.stamp;
}

Finding EStopLatch::update(Time now, const std::optional<Stamped<PinState>>& pins, bool exists,
                           bool clear_asked) {
  exists_ = exists_ || exists || pins;
  if (pins && pins->stamp <= now + kStampJitter) take(*pins);
  if (pins && pins->value.estop_pressed) {  // whatever its stamp
    latched_ = pressed_ = true;
    released_since_.reset();
  }
  const bool fresh = read_ && is_fresh(*read_, now, timeout_);
  const bool released = fresh && !pressed_ && released_since_ && now - *released_since_ >= release_;
  if (clear_asked && released) latched_ = false;
  if (latched_ && pressed_)
    return {Cause::kEStopPin, {Motion::kEStop, "e-stop pressed: release it, then clear the stop"}};
  if (latched_) return {Cause::kEStopPin, {Motion::kEStop, "e-stop was pressed: clear the stop to go on"}};
  if (exists_ && !fresh)
    return {Cause::kPinsSilent,
            {Motion::kStop, "e-stop not read" + (read_ ? " for " + seconds_text(now - *read_) : "")}};
  return {};
}

Finding StopLatch::update(const std::optional<std::string>& asked, bool clear_asked) {
  if (asked) {
    why_ = asked;
  } else if (clear_asked) {
    why_.reset();
  }
  if (!why_) return {};
  const std::string what = why_->empty() ? std::string("stopped") : "stopped: " + *why_;
  return {Cause::kStopAsked, {Motion::kEStop, what + "; clear the stop to go on"}};
}

}  // namespace dynslam
