// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <mutex>
#include <optional>

#include "base/time.h"
#include "drivers/chip_faults.h"
#include "drivers/i2c_chip.h"

namespace dynslam::test {

/// A ThunderBorg, written from its list of commands and not by the driver's code. Any thread.
class ThunderBorgEmulator : public I2cChip {
  template <class Do>
  auto with_lock(Do&& action) const {
    const std::lock_guard lock(mutex_);
    return action();
  }

 public:
  using Now = std::function<Time()>;
  using Driven = std::function<void(double a, double b)>;

  /// `now` is the clock that the failsafe goes by.
  explicit ThunderBorgEmulator(Now now) : now_(std::move(now)) {}
  /// Told of each command to the motors, and what they have then; that the failsafe struck it is not told.
  void on_driven(Driven driven) {
    with_lock([&] { driven_ = std::move(driven); });
  }

  int write(std::span<const std::uint8_t> bytes) override;
  int read(std::span<std::uint8_t> into) override;

  /// -1 to 1, 0 once the failsafe struck.
  double power_a() const { return power(a_); }
  double power_b() const { return power(b_); }
  bool failsafe_on() const {
    return with_lock([&] { return failsafe_; });
  }
  /// What the lights show; nothing: the battery.
  std::optional<std::array<int, 3>> lights() const {
    return with_lock([&] { return lights_; });
  }

  void set_battery_v(double v) {
    with_lock([&] { battery_v_ = v; });
  }
  void set_motor_faults(bool a, bool b) {
    with_lock([&] { fault_a_ = a, fault_b_ = b; });
  }
  /// As when the power was gone for a moment.
  void reset() {
    with_lock([&] { switch_on(); });
  }
  void fail(int error, int times) {
    with_lock([&] { faults_.fail(error, times); });
  }
  void garble(Garble how, int times) {
    with_lock([&] { faults_.garble(how, times); });
  }
  /// The next commands to motors are acknowledged and forgotten.
  void forget_commands(int times) {
    with_lock([&] { forgets_ = times; });
  }
  void refuse_failsafe(bool refuses) {
    with_lock([&] { refuses_failsafe_ = refuses; });
  }
  void set_identity(int identity) {
    with_lock([&] { identity_ = identity; });
  }
  int transfers() const {
    return with_lock([&] { return transfers_; });
  }

 private:
  struct Motor {
    int direction = 1, pwm = 0;
  };

  double power(const Motor& motor) const;
  static double power_of(const Motor& motor) {
    return (motor.direction == 1 ? 1.0 : -1.0) * motor.pwm / 255.0;
  }
  bool failsafe_struck() const;
  void switch_on();
  void tell_driven();
  void command(int code, std::span<const std::uint8_t> values);
  void set_motor(Motor& motor, int direction, int pwm);
  std::array<int, 3> answer() const;

  mutable std::mutex mutex_;
  Now now_;
  Driven driven_;
  ChipFaults faults_;
  Motor a_, b_;
  Time commanded_;
  bool failsafe_ = false, refuses_failsafe_ = false, fault_a_ = false, fault_b_ = false;
  double battery_v_ = 12.5;
  std::optional<std::array<int, 3>> lights_;
  int forgets_ = 0, question_ = 0, identity_ = 0x15, transfers_ = 0;
};

}  // namespace dynslam::test
