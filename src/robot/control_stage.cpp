// SPDX-License-Identifier: MIT
#include "robot/control_stage.h"

#include <algorithm>

#include "device/device_error.h"

namespace dynslam {
namespace {

/// Reading the board takes as long as driving it; brownouts last some tenths of a second.
constexpr Duration kReadMotorsEvery = std::chrono::milliseconds(100);
constexpr Duration kBumpersCountFor = std::chrono::seconds(1);
constexpr Duration kShowCountersEvery = std::chrono::seconds(1);

template <class T>
std::optional<T> value_of(const typename Latest<T>::Item& item) {
  return item.value ? std::optional<T>(*item.value) : std::nullopt;
}

}  // namespace

ControlStage::ControlStage(Motors* motors, Pins* pins, const DriveConfig& config, const Clock& clock,
                           Ports& ports, const Latest<ImuSample>& imu, bool has_imu)
    : motors_(motors),
      pins_(pins),
      clock_(clock),
      ports_(ports),
      imu_(imu),
      control_(config),
      due_(clock.now()),
      motors_due_(due_),
      motors_health_(motors, ports.motors_health),
      pins_health_(pins, ports.pins_health) {
  inputs_.has_estop = pins != nullptr;
  inputs_.has_imu = has_imu;
}

void ControlStage::turn() {
  const Time begun = clock_.now();
  read_motors(begun);
  read_pins(begun);
  inputs_.command = value_of<DriveCommand>(ports_.command.get());
  inputs_.driver_left = ports_.driver_left.exchange(false);  // after the command: none is older than this
  inputs_.scan = ports_.scan.get().value;
  inputs_.imu = value_of<ImuSample>(imu_.get());
  inputs_.power_limit = ports_.power_limit;
  inputs_.supply_low = ports_.supply_low;
  inputs_.clear_asked = ports_.clear_asked.exchange(false);
  inputs_.stop_asked.reset();
  while (auto by = ports_.stops.try_pop()) inputs_.stop_asked = std::move(by);

  const Time now = clock_.now();
  const DriveOutput out = control_.step(now, inputs_);
  if (motors_) motors_->show(out.verdict.motion);
  const bool driven = drive(out.power);
  const auto& command = inputs_.command;
  if (driven && command &&
      (!answered_ || command->seq != answered_->seq || command->heard != answered_->heard)) {
    answered_ = command;
    answered_at_ = clock_.now();
  }
  ports_.drive.put(drive_state(now, out));
  if (now >= counters_due_) {
    counters_due_ = now + kShowCountersEvery;
    ports_.drive_counters.put(control_.refused());
  }
  due_ = std::max(due_ + kTick, now);  // ticks that were missed are not made up for
  if (const auto deadline = control_.deadline(); deadline && *deadline > now)
    due_ = std::min(due_, *deadline);
}

DriveState ControlStage::drive_state(Time now, const DriveOutput& out) {
  DriveState state{now, answered_, answered_at_, out.verdict, out.applied, out.power, out.battery};
  state.cause = out.cause;
  state.attitude = attitude_.update(now, inputs_.imu);
  if (inputs_.pins && now - inputs_.pins->stamp < kBumpersCountFor)
    state.collision = inputs_.pins->value.bumper_pressed;
  return state;
}

void ControlStage::halt() {
  inputs_.command.reset();
  drive({});
}

void ControlStage::read_motors(Time now) {
  if (!motors_ || now < motors_due_) return;
  motors_due_ = now + kReadMotorsEvery;
  try {
    inputs_.motors = {clock_.now(), motors_->read()};
    motors_health_.answered(now);
  } catch (const DeviceError& e) {
    motors_health_.failed(e.what());
  }
}

void ControlStage::read_pins(Time now) {
  if (!pins_) return;
  try {
    inputs_.pins = {clock_.now(), pins_->read()};
    pins_health_.answered(now);
  } catch (const DeviceError& e) {
    pins_health_.failed(e.what());
  }
}

bool ControlStage::drive(const WheelPower& power) {
  if (!motors_) return true;
  try {
    motors_->drive(power);
    return true;
  } catch (const DeviceError& e) {
    motors_health_.failed(e.what());
    return false;
  }
}

}  // namespace dynslam
