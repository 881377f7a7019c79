// SPDX-License-Identifier: MIT
#include "drive/drive_control.h"

#include <algorithm>
#include <cmath>

namespace dynslam {

DriveControl::DriveControl(const DriveConfig& config)
    : heartbeat_(config.heartbeat),
      battery_(config.battery),
      kinematics_(config.kinematics),
      ramp_(config.kinematics),
      safety_(config.safety, config.body, config.clearance) {}

DriveOutput DriveControl::step(Time now, const DriveInputs& in) {
  const Duration passed = now_ ? now - *now_ : Duration(0);
  now_ = now;
  DriveOutput out;
  if (in.driver_left) heartbeat_.driver_left();
  heartbeat_.update(now, in.command);
  out.battery_changed = watch_battery(now, in);

  const Twist ramped = ramp_.toward(wanted(in), passed);
  const Decision decision = safety_.decide(now, safety_inputs(in, ramped));
  const Motion motion = decision.worst.verdict.motion;
  if (motion >= Motion::kStop) heartbeat_.require_release();
  if (motion < Motion::kHold) out.applied = {decision.share * ramped.v_mps, decision.share * ramped.w_radps};
  out.power = kinematics_.power(out.applied, battery_.voltage_v());

  ramp_.set(out.applied);
  safety_.driven(now, out.applied, out.power, in.imu);
  log(now, decision.worst);
  out.verdict = decision.worst.verdict;
  out.cause = decision.worst.cause;
  out.battery = battery_.shown();
  return out;
}

/// Each reading counts once.
bool DriveControl::watch_battery(Time now, const DriveInputs& in) {
  std::optional<double> voltage_v;
  if (in.motors && in.motors->stamp != battery_read_ && in.motors->stamp <= now + kStampJitter) {
    voltage_v = in.motors->value.battery_v;
    battery_read_ = in.motors->stamp;
  }
  return battery_.update(now, voltage_v, in.supply_low);
}

/// What the driver asks for, within the power limits and what the wheels can do. The user's limit maps the
/// whole range of the stick to a part of the speed (thesis, 3); so does what brownouts leave.
Twist DriveControl::wanted(const DriveInputs& in) const {
  const Twist asked = kinematics_.reachable(heartbeat_.wanted(), battery_.voltage_v());
  const double limit =
      in.power_limit > 0.0 ? std::min(in.power_limit, 1.0) : 0.0;  // nor what is not a number
  const double share = limit * battery_.power_share();
  return {share * asked.v_mps, share * asked.w_radps};
}

SafetyInputs DriveControl::safety_inputs(const DriveInputs& in, const Twist& twist) const {
  SafetyInputs safety;
  safety.twist = twist;
  if (heartbeat_.state() != Heartbeat::State::kAlive) safety.driver_missing = heartbeat_.reason();
  safety.scan = in.scan;
  safety.has_imu = in.has_imu;
  safety.imu = in.imu;
  safety.motors = in.motors;
  safety.has_estop = in.has_estop;
  safety.pins = in.pins;
  safety.stop_asked = in.stop_asked;
  safety.clear_asked = in.clear_asked;
  safety.battery = battery_.shown();
  safety.battery_power = battery_.power_share();
  return safety;
}

void DriveControl::log(Time now, const Finding& worst) {
  const bool same = cause_ == worst.cause && transitions_.back().verdict.motion == worst.verdict.motion;
  if (same) return;
  cause_ = worst.cause;
  transitions_.push_back({now, worst.verdict});
  if (transitions_.size() > kMostTransitions) transitions_.pop_front();
}

}  // namespace dynslam
