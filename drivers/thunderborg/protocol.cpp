// SPDX-License-Identifier: MIT
#include "drivers/thunderborg/protocol.h"

#include <algorithm>
#include <cmath>

namespace dynslam::thunderborg {
namespace {

constexpr int kForward = 1, kReverse = 2;
constexpr int kBatterySteps = 1023;
constexpr double kBatteryRange_v = 36.3;

}  // namespace

std::optional<int> decode_motor(const Answer& answer) {
  const int direction = answer[1], power = answer[2];
  if (power == 0 || direction == kForward) return power;
  if (direction == kReverse) return -power;
  return std::nullopt;
}

std::optional<bool> decode_flag(const Answer& answer) {
  if (answer[1] > 1) return std::nullopt;
  return answer[1] == 1;
}

std::optional<double> decode_battery_v(const Answer& answer) {
  const int steps = answer[1] * 256 + answer[2];
  if (steps > kBatterySteps) return std::nullopt;
  return steps * kBatteryRange_v / kBatterySteps;
}

int motor_power(double share) {
  return static_cast<int>(std::lround(std::clamp(share, -1.0, 1.0) * kFullPower));
}

}  // namespace dynslam::thunderborg
