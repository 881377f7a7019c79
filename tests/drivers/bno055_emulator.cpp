// SPDX-License-Identifier: MIT
#include "drivers/bno055_emulator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dynslam::test {
namespace {

using std::chrono::milliseconds;

constexpr int kUnits = 0x3b, kMode = 0x3d, kTrigger = 0x3f, kMap = 0x41, kProfileAt = 0x55;

double heading_of(const Eigen::Matrix3d& world_R_body) {
  return std::atan2(world_R_body(1, 0), world_R_body(0, 0));
}

Eigen::Matrix3d turn_left(double rad) {
  return Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

}  // namespace

Bno055Emulator::Bno055Emulator(Now now, Feel feel) : now_(std::move(now)), feel_(std::move(feel)) {
  switch_on();
  awake_ = now_();
}

void Bno055Emulator::switch_on() {
  registers_ = {};
  at(kUnits) = 0x80;  // some data sheets say so: who relies on 0 is wrong
  at(kMap) = 0x24;
  frozen_ = false;
  awake_ = now_() + milliseconds(650);
  mode_since_ = now_();
}

int Bno055Emulator::write(std::span<const std::uint8_t> bytes) {
  return with_lock([&] {
    if (const int error = faults_.next_error()) return error;
    if (now_() < awake_) return EREMOTEIO;
    pointer_ = bytes[0] & 0x7f;
    for (const std::uint8_t value : bytes.subspan(1)) {
      store(pointer_, value);
      pointer_ = (pointer_ + 1) & 0x7f;
    }
    return 0;
  });
}

int Bno055Emulator::read(std::span<std::uint8_t> into) {
  return with_lock([&] {
    if (const int error = faults_.next_error()) return error;
    if (now_() < awake_) return EREMOTEIO;
    measure();
    for (std::uint8_t& byte : into) {
      byte = at(pointer_);
      pointer_ = (pointer_ + 1) & 0x7f;
    }
    faults_.spoil(into);
    return 0;
  });
}

void Bno055Emulator::store(int reg, std::uint8_t value) {
  if (reg == kMode && value != at(kMode)) {
    at(kMode) = value;
    mode_since_ = now_();
    begins_ = true;
  } else if (reg == kTrigger && (value & 0x20)) {
    ++resets_;
    switch_on();
  } else if (at(kMode) == 0 && now_() - mode_since_ >= milliseconds(19) && reg >= kUnits) {
    at(reg) = value;  // the rest is for reading, and these only outside of fusion
  }
}

bool Bno055Emulator::is_fusing() const {
  return (at(kMode) == 0x08 || at(kMode) == 0x0c) && now_() - mode_since_ >= milliseconds(20);
}

/// The axes that it speaks of, in terms of its own.
Eigen::Matrix3d Bno055Emulator::chip_R_output() const {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const int axis = at(kMap) >> 2 * i & 3;
    const bool minus = at(kMap + 1) >> (2 - i) & 1;
    if (axis < 3) axes(axis, i) = minus ? -1 : 1;
  }
  return axes;
}

void Bno055Emulator::put(int reg, double value) {
  const auto steps = static_cast<int>(std::lround(value));
  at(reg) = static_cast<std::uint8_t>(steps & 0xff);
  at(reg + 1) = static_cast<std::uint8_t>(steps >> 8 & 0xff);
}

/// -1, 0 or 1.
int Bno055Emulator::noise() {
  noise_ = noise_ * 1103515245U + 12345U;
  return static_cast<int>(noise_ >> 16) % 3 - 1;
}

void Bno055Emulator::measure() {
  at(0) = static_cast<std::uint8_t>(chip_id_);
  at(1) = 0xfb, at(2) = 0x32, at(3) = 0x0f, at(4) = 0x11, at(5) = 0x03, at(6) = 0x15;
  at(0x34) = static_cast<std::uint8_t>(temperature_c_);
  at(0x35) = calibration_;
  at(0x36) = 0x0f;
  at(0x39) = is_fusing() ? 5 : 0;
  if (frozen_) return;
  if (!is_fusing()) {
    std::fill(registers_.begin() + 0x08, registers_.begin() + 0x34, std::uint8_t{0});
    return;
  }
  const TrueMotion motion = feel_();
  const Eigen::Matrix3d robot_R_output = robot_q_chip_.toRotationMatrix() * chip_R_output();
  Eigen::Matrix3d world_R_output = motion.world_q_robot.toRotationMatrix() * robot_R_output;
  if (begins_) first_heading_rad_ = at(kMode) == 0x08 ? heading_of(world_R_output) : 0.0;
  begins_ = false;
  const bool kicked = kicks_ > 0 && pointer_ == 0x14;
  const double kick = kicked ? kick_rad_ : 0.0;
  kicks_ -= kicked;
  world_R_output = turn_left(kick - first_heading_rad_) * world_R_output;
  const Eigen::Vector3d rate = robot_R_output.transpose() * motion.rate_radps;
  const Eigen::Vector3d up = 9.81 * world_R_output.row(2).transpose();
  const Eigen::Quaterniond q(world_R_output);
  for (int i = 0; i < 3; ++i) {
    put(0x08 + 2 * i, 100 * up[i] + noise());  // an accelerometer is never at rest
    put(0x14 + 2 * i, 16 * rate[i] * 180 / std::numbers::pi);
    put(0x22 + 2 * i, 16384 * q.vec()[i]);
  }
  put(0x20, 16384 * q.w());
  double clockwise_deg = -heading_of(world_R_output) * 180 / std::numbers::pi;
  if (clockwise_deg < 0) clockwise_deg += 360;
  put(0x1a, 16 * clockwise_deg);
}

void Bno055Emulator::set_calibration(int system, int gyroscope, int accelerometer, int magnetometer) {
  with_lock([&] {
    calibration_ =
        static_cast<std::uint8_t>(system << 6 | gyroscope << 4 | accelerometer << 2 | magnetometer);
  });
}

void Bno055Emulator::set_profile(const Profile& profile) {
  with_lock([&] { std::copy(profile.begin(), profile.end(), &at(kProfileAt)); });
}

Bno055Emulator::Profile Bno055Emulator::profile() const {
  return with_lock([&] {
    Profile profile;
    std::copy_n(&at(kProfileAt), profile.size(), profile.begin());
    return profile;
  });
}

}  // namespace dynslam::test
