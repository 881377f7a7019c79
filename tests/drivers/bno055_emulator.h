// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>

#include <Eigen/Geometry>

#include "base/time.h"
#include "drivers/chip_faults.h"
#include "drivers/i2c_chip.h"

namespace dynslam::test {

/// How the robot really is.
struct TrueMotion {
  Eigen::Quaterniond world_q_robot = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();  ///< about the robot's axes
};

/// A BNO055 in its IMU and NDOF modes, written from the data sheet and not by the driver's code. Its heading
/// is 0 where fusion began, or true in NDOF. Any thread.
class Bno055Emulator : public I2cChip {
  template <class Do>
  auto with_lock(Do&& action) const {
    const std::lock_guard lock(mutex_);
    return action();
  }

 public:
  using Now = std::function<Time()>;
  using Feel = std::function<TrueMotion()>;
  using Profile = std::array<std::uint8_t, 22>;

  /// `now` is the clock that its own times go by; `feel` is called at each reading.
  Bno055Emulator(Now now, Feel feel);

  int write(std::span<const std::uint8_t> bytes) override;
  int read(std::span<std::uint8_t> into) override;

  /// How the chip is mounted: turns its axes into the robot's. Level and ahead at first.
  void set_mount(const Eigen::Quaterniond& robot_q_chip) {
    with_lock([&] { robot_q_chip_ = robot_q_chip; });
  }
  /// 0 to 3 each.
  void set_calibration(int system, int gyroscope, int accelerometer, int magnetometer);
  void set_temperature_c(int c) {
    with_lock([&] { temperature_c_ = c; });
  }
  /// What it will have found out about itself.
  void set_profile(const Profile& profile);
  Profile profile() const;
  int mode() const {
    return with_lock([&] { return int{at(0x3d)}; });
  }
  int resets() const {
    return with_lock([&] { return resets_; });
  }

  /// As when its power was gone for a moment.
  void reset() {
    with_lock([&] { switch_on(); });
  }
  void fail(int error, int times) {
    with_lock([&] { faults_.fail(error, times); });
  }
  void garble(Garble how, int times) {
    with_lock([&] { faults_.garble(how, times); });
  }
  /// Goes on answering, but measures nothing any more, until it is reset.
  void freeze() {
    with_lock([&] { frozen_ = true; });
  }
  /// The next readings have the heading off by so much.
  void kick(double yaw_rad, int times) {
    with_lock([&] { kick_rad_ = yaw_rad, kicks_ = times; });
  }
  void set_chip(int id) {
    with_lock([&] { chip_id_ = id; });
  }

 private:
  std::uint8_t& at(int reg) { return registers_[static_cast<std::size_t>(reg)]; }
  const std::uint8_t& at(int reg) const { return registers_[static_cast<std::size_t>(reg)]; }
  void put(int reg, double value);
  void switch_on();
  void store(int reg, std::uint8_t value);
  bool is_fusing() const;
  int noise();
  void measure();
  Eigen::Matrix3d chip_R_output() const;

  mutable std::mutex mutex_;
  Now now_;
  Feel feel_;
  ChipFaults faults_;
  std::array<std::uint8_t, 128> registers_{};
  int pointer_ = 0, resets_ = 0, temperature_c_ = 25, kicks_ = 0, chip_id_ = 0xa0;
  std::uint32_t noise_ = 1;
  std::uint8_t calibration_ = 0;
  double kick_rad_ = 0.0, first_heading_rad_ = 0.0;
  bool frozen_ = false, begins_ = false;
  Time awake_, mode_since_;
  Eigen::Quaterniond robot_q_chip_ = Eigen::Quaterniond::Identity();
};

}  // namespace dynslam::test
