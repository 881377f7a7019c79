// SPDX-License-Identifier: MIT
#include "drivers/thunderborg_emulator.h"

#include <algorithm>
#include <cmath>

namespace dynslam::test {

int ThunderBorgEmulator::write(std::span<const std::uint8_t> bytes) {
  return with_lock([&] {
    ++transfers_;
    if (const int error = faults_.next_error()) return error;
    if (!bytes.empty()) command(bytes[0], bytes.subspan(1));
    return 0;
  });
}

int ThunderBorgEmulator::read(std::span<std::uint8_t> into) {
  return with_lock([&] {
    ++transfers_;
    if (const int error = faults_.next_error()) return error;
    std::fill(into.begin(), into.end(), std::uint8_t{0});
    const std::array<int, 3> says = answer();
    for (std::size_t i = 0; i < std::min(into.size(), says.size()); ++i)
      into[i] = static_cast<std::uint8_t>(says[i]);
    faults_.spoil(into);
    return 0;
  });
}

double ThunderBorgEmulator::power(const Motor& motor) const {
  return with_lock([&] { return failsafe_struck() ? 0.0 : power_of(motor); });
}

bool ThunderBorgEmulator::failsafe_struck() const {
  return failsafe_ && now_() - commanded_ > std::chrono::milliseconds(250);
}

void ThunderBorgEmulator::switch_on() {
  a_ = b_ = {};
  failsafe_ = false;
  lights_.reset();
  tell_driven();
}

void ThunderBorgEmulator::tell_driven() {
  if (driven_) driven_(power_of(a_), power_of(b_));
}

void ThunderBorgEmulator::set_motor(Motor& motor, int direction, int pwm) {
  if (forgets_ > 0) {
    --forgets_;
    return;
  }
  if (failsafe_struck()) a_.pwm = b_.pwm = 0;
  motor = {direction, pwm};
  commanded_ = now_();
  tell_driven();
}

void ThunderBorgEmulator::command(int code, std::span<const std::uint8_t> values) {
  const auto value = [&](std::size_t i) { return i < values.size() ? int{values[i]} : 0; };
  switch (code) {
    case 5:
      if (lights_) lights_ = {value(0), value(1), value(2)};
      break;
    case 6:
      lights_ = value(0) ? std::nullopt : std::optional(lights_.value_or(std::array<int, 3>{}));
      break;
    case 8:
    case 9:
      set_motor(a_, code - 7, value(0));
      break;
    case 11:
    case 12:
      set_motor(b_, code - 10, value(0));
      break;
    case 14:
      a_.pwm = b_.pwm = 0;
      commanded_ = now_();
      tell_driven();
      break;
    case 19:
      failsafe_ = value(0) == 1 && !refuses_failsafe_;
      commanded_ = now_();
      break;
    default:
      question_ = code;
  }
}

std::array<int, 3> ThunderBorgEmulator::answer() const {
  const auto motor = [&](const Motor& m) {
    return std::array{question_, m.direction, failsafe_struck() ? 0 : m.pwm};
  };
  const int battery = static_cast<int>(std::lround(battery_v_ / 36.3 * 1023));
  switch (question_) {
    case 10:
      return motor(a_);
    case 13:
      return motor(b_);
    case 15:
      return {question_, fault_a_, 0};
    case 16:
      return {question_, fault_b_, 0};
    case 20:
      return {question_, failsafe_, 0};
    case 21:
      return {question_, battery / 256, battery % 256};
    case 0x99:
      return {question_, identity_, 0};
    default:
      return {};
  }
}

}  // namespace dynslam::test
