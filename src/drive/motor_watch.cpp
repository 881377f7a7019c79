// SPDX-License-Identifier: MIT
#include "drive/motor_watch.h"

#include <string>

#include "drive/words.h"

namespace dynslam {

void MotorWatch::clock_went_back() {
  newest_.reset();
  fault_since_.reset();
}

Finding MotorWatch::update(Time now, const std::optional<Stamped<MotorState>>& motors,
                           const WheelPower& power) {
  left_driven_ = left_driven_ || power.left != 0.0;
  right_driven_ = right_driven_ || power.right != 0.0;
  if (motors && motors->stamp <= now + kStampJitter && (!newest_ || motors->stamp > newest_->stamp))
    newest_ = motors;
  if (!newest_ || !is_fresh(newest_->stamp, now, timeout_)) {
    const std::string since = newest_ ? " for " + seconds_text(now - newest_->stamp) : std::string();
    return {Cause::kMotorsSilent, {Motion::kStop, "motor board does not answer" + since}};
  }
  if (!newest_->value.failsafe_on)
    return {Cause::kFailsafeOff, {Motion::kStop, "the motor board's own failsafe is off"}};
  return faults();
}

/// A fault lasts from the first reading that shows it to the newest one.
Finding MotorWatch::faults() {
  const MotorState& state = newest_->value;
  const bool fault = (state.left_fault || state.right_fault) && left_driven_ && right_driven_;
  if (!fault) {
    fault_since_.reset();
    return {};
  }
  if (!fault_since_) fault_since_ = newest_->stamp;
  if (newest_->stamp - *fault_since_ <= fault_) return {};
  const char* which = state.left_fault && state.right_fault ? "both motors"
                      : state.left_fault                    ? "the left motor"
                                                            : "the right motor";
  return {Cause::kMotorFault,
          {Motion::kStop, std::string("fault at ") + which + ": see to wiring and battery"}};
}

}  // namespace dynslam
