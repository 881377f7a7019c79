// SPDX-License-Identifier: MIT
#include "drivers/gpio/wheel_encoders.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/gpio/chips.h"

namespace dynslam {
namespace {

/// Left A, left B, right A, right B.
std::array<LineUse, 4> uses_of(const EncodersConfig& config) {
  const auto use = [](int line) { return LineUse{static_cast<unsigned>(line), false, Pull::kUp}; };
  return {use(config.left_a_line), use(config.left_b_line), use(config.right_a_line),
          use(config.right_b_line)};
}

}  // namespace

void WheelOdometry::roll(double left_m, double right_m) {
  const double way_m = 0.5 * (left_m + right_m);
  const double turn = (right_m - left_m) / track_m_;
  // The chord of the arc lies half the turn aside.
  const double chord_m = std::abs(turn) < 1e-9 ? way_m : way_m * std::sin(0.5 * turn) / (0.5 * turn);
  const Pose2 step{chord_m * std::cos(0.5 * turn), chord_m * std::sin(0.5 * turn), turn};
  odom_T_robot_ = odom_T_robot_ * step;
}

WheelEncoders::WheelEncoders(const EncodersConfig& config, const Clock& clock)
    : WheelEncoders(config, clock, [chip = config.chip](std::span<const LineUse> uses) {
        return open_inputs(find_chip(chip, "wheels"), uses, "wheels");
      }) {}

WheelEncoders::WheelEncoders(const EncodersConfig& config, const Clock& clock, OpenInputs open)
    : config_(config), clock_(clock), open_(std::move(open)), odometry_(config.track_m) {}

std::optional<OdometrySample> WheelEncoders::next(Time until) {
  try {
    if (!lines_) open();
    const Time end = std::min(due_, until);
    do count(clock_.steady(end));
    while (clock_.now() < end);
    std::array<bool, 4> levels{};
    lines_->read(levels);  // only to hear of it when the chip went: edges do not tell
  } catch (const DeviceError&) {
    lines_.reset();
    throw;
  }
  const Time now = clock_.now();
  if (now < due_) return std::nullopt;
  due_ = std::max(due_ + kPeriod, now);
  const double left_m = rolled_m(wheels_[0], config_.left_reversed);
  const double right_m = rolled_m(wheels_[1], config_.right_reversed);
  odometry_.roll(left_m, right_m);
  return OdometrySample{now, odometry_.odom_T_robot()};
}

void WheelEncoders::open() {
  illegal_before_ = illegal_steps();
  wheels_ = {};
  lines_ = open_(uses_of(config_));
  std::array<bool, 4> levels{};
  lines_->read(levels);
  for (std::size_t i = 0; i < 2; ++i) wheels_[i].counter.see(levels[2 * i], levels[2 * i + 1]);
  due_ = clock_.now() + kPeriod;
}

void WheelEncoders::count(Clock::SteadyTime until) {
  const std::size_t n = lines_->take_edges(edges_, until);
  for (std::size_t i = 0; i < n; ++i)
    wheels_.at(edges_[i].index / 2).counter.edge(edges_[i].index % 2 == 0, edges_[i].active);
}

double WheelEncoders::rolled_m(Wheel& wheel, bool reversed) const {
  const std::int64_t steps = wheel.counter.count() - std::exchange(wheel.told, wheel.counter.count());
  return (reversed ? -1.0 : 1.0) * static_cast<double>(steps) * config_.metres_per_step;
}

std::string WheelEncoders::about() const {
  return "encoders on lines " + std::to_string(config_.left_a_line) + " and " +
         std::to_string(config_.left_b_line) + " (left), " + std::to_string(config_.right_a_line) + " and " +
         std::to_string(config_.right_b_line) + " (right)";
}

Counters WheelEncoders::counters() const {
  Counters all;
  if (const auto illegal = illegal_steps(); illegal > 0) all.add("illegal-steps", illegal);
  return all;
}

std::uint64_t WheelEncoders::illegal_steps() const {
  return illegal_before_ + wheels_[0].counter.illegal() + wheels_[1].counter.illegal();
}

}  // namespace dynslam
