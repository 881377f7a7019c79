// SPDX-License-Identifier: MIT
#include "drive/kinematics.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

/// A freshly charged battery, over the rated voltage of its motors.
constexpr double kFreshlyCharged = 1.17;
/// A wheel asked for less than this share of its speed stands.
constexpr double kLeastSpeed = 0.002;

}  // namespace

double Kinematics::supply_v(std::optional<double> battery_v) const {
  const bool known = battery_v && std::isfinite(*battery_v) && *battery_v > 0.0;
  return known ? *battery_v : kFreshlyCharged * config_.motor_rated_v;
}

double Kinematics::most_power(std::optional<double> battery_v) const {
  return std::min(config_.motor_rated_v / supply_v(battery_v), config_.max_power);
}

/// Of a wheel, with as much power as it may have.
double Kinematics::fastest_mps(double supply_v) const {
  return speed_of_wheel(most_power(supply_v), supply_v);
}

Twist Kinematics::reachable(const Twist& twist, std::optional<double> battery_v) const {
  if (!is_finite(twist)) return {};
  const double faster_wheel = std::abs(twist.v_mps) + std::abs(twist.w_radps) * half_track_m();
  double share = 1.0;
  if (const double most = fastest_mps(supply_v(battery_v)); faster_wheel > most) share = most / faster_wheel;
  if (const double turn = share * std::abs(twist.w_radps); turn > config_.max_turn_radps)
    share *= config_.max_turn_radps / turn;
  return {share * twist.v_mps, share * twist.w_radps};
}

double Kinematics::power_of_wheel(double speed_mps, double supply_v) const {
  const double speed = std::abs(speed_mps) / config_.max_speed_mps;
  if (speed < kLeastSpeed) return 0.0;
  const double voltage = config_.deadband + (1.0 - config_.deadband) * speed;  // share of the rated one
  const double power = std::min(voltage * config_.motor_rated_v / supply_v, most_power(supply_v));
  return std::copysign(power, speed_mps);
}

double Kinematics::speed_of_wheel(double power, double supply_v) const {
  const double voltage = std::abs(power) * supply_v / config_.motor_rated_v;
  const double speed = std::max(0.0, (voltage - config_.deadband) / (1.0 - config_.deadband));
  return std::copysign(speed * config_.max_speed_mps, power);
}

WheelPower Kinematics::power(const Twist& wanted, std::optional<double> battery_v) const {
  const Twist t = reachable(wanted, battery_v);
  const double supply = supply_v(battery_v), difference = t.w_radps * half_track_m();
  return {power_of_wheel(t.v_mps - difference, supply), power_of_wheel(t.v_mps + difference, supply)};
}

Twist Kinematics::twist(const WheelPower& power, std::optional<double> battery_v) const {
  const double supply = supply_v(battery_v);
  const double left = speed_of_wheel(power.left, supply), right = speed_of_wheel(power.right, supply);
  return {0.5 * (left + right), 0.5 * (right - left) / half_track_m()};
}

}  // namespace dynslam
