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

Kinematics::WheelSpeeds Kinematics::speeds(const Twist& t) const {
  return {t.v_mps - t.w_radps * half_track_m(), t.v_mps + t.w_radps * half_track_m()};
}

/// What moving takes, as a share of the rated voltage: more and more from driving straight to turning on the
/// spot. The same for all speeds on an arc.
double Kinematics::friction(const WheelSpeeds& s) const {
  const double both = std::abs(s.left) + std::abs(s.right);
  return config_.deadband + (both > 0.0 ? config_.turn_deadband * std::abs(s.right - s.left) / both : 0.0);
}

Twist Kinematics::reachable(const Twist& twist, std::optional<double> battery_v) const {
  if (!is_finite(twist)) return {};
  const WheelSpeeds wanted = speeds(twist);
  const double supply = supply_v(battery_v), voltage = most_power(supply) * supply / config_.motor_rated_v;
  const double most =
      std::max(0.0, voltage - friction(wanted)) / (1.0 - config_.deadband) * config_.max_speed_mps;
  double share = 1.0;
  if (const double faster = std::max(std::abs(wanted.left), std::abs(wanted.right)); faster > most)
    share = most / faster;
  if (const double turn = share * std::abs(twist.w_radps); turn > config_.max_turn_radps)
    share *= config_.max_turn_radps / turn;
  return {share * twist.v_mps, share * twist.w_radps};
}

double Kinematics::power_of_wheel(double speed_mps, double friction, double supply_v) const {
  const double speed = std::abs(speed_mps) / config_.max_speed_mps;
  if (speed < kLeastSpeed) return 0.0;
  const double voltage = friction + (1.0 - config_.deadband) * speed;  // share of the rated one
  const double power = std::min(voltage * config_.motor_rated_v / supply_v, most_power(supply_v));
  return std::copysign(power, speed_mps);
}

WheelPower Kinematics::power(const Twist& wanted, std::optional<double> battery_v) const {
  const WheelSpeeds wheels = speeds(reachable(wanted, battery_v));
  const double supply = supply_v(battery_v), needed = friction(wheels);
  return {power_of_wheel(wheels.left, needed, supply), power_of_wheel(wheels.right, needed, supply)};
}

}  // namespace dynslam
