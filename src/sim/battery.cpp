// SPDX-License-Identifier: MIT
#include "sim/battery.h"

#include <algorithm>
#include <array>

namespace dynslam {
namespace {

struct Point {
  double share, volts;
};
constexpr std::array<Point, 6> kOpenCircuit = {
    {{0.0, 9.5}, {0.05, 11.0}, {0.2, 12.0}, {0.5, 12.6}, {0.9, 13.2}, {1.0, 13.9}}};

double open_circuit_v(double share) {
  std::size_t i = 1;
  while (i + 1 < kOpenCircuit.size() && share > kOpenCircuit[i].share) ++i;
  const Point &a = kOpenCircuit[i - 1], &b = kOpenCircuit[i];
  return a.volts + (share - a.share) / (b.share - a.share) * (b.volts - a.volts);
}

}  // namespace

void Battery::set_share(double share) { share_ = std::clamp(share, 0.0, 1.0); }

void Battery::step(double current_a, double dt_s) {
  constexpr double kSettling_s = 0.01;  // capacitors on the board
  current_a_ += (current_a - current_a_) * std::min(1.0, dt_s / kSettling_s);
  set_share(share_ - current_a * dt_s / kCapacityAs);
}

double Battery::voltage_v() const { return open_circuit_v(share_) - current_a_ * kResistance_ohm; }

}  // namespace dynslam
