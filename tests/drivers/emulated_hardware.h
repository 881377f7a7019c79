// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <memory>
#include <string>

#include "config.h"
#include "drivers/bno055_emulator.h"
#include "drivers/driven_world.h"
#include "drivers/emulated_gpio_chip.h"
#include "drivers/mock_i2c_bus.h"
#include "drivers/rplidar_emulator.h"
#include "drivers/thunderborg_emulator.h"

namespace dynslam::test {

/// All hardware of a robot behind the system calls that its drivers make, moving and measuring in a simulated
/// world in real time: an RPLIDAR A3 at a pseudo-terminal, a BNO055 on the bus /dev/i2c-3 that the processor
/// moves itself, a ThunderBorg on /dev/i2c-1, and a chip of GPIO lines with e-stop and bumper. All of it is
/// plugged in at first, or nothing. Needs umockdev's library (mocked_main.cpp).
class EmulatedHardware {
 public:
  enum class Plugged { kAll, kNothing };

  explicit EmulatedHardware(const World& emulated, Plugged plugged = Plugged::kAll);
  ~EmulatedHardware();
  EmulatedHardware(const EmulatedHardware&) = delete;
  EmulatedHardware& operator=(const EmulatedHardware&) = delete;

  /// How the devices are reached; no camera.
  Config config() const;
  /// An empty folder of its own.
  const std::string& folder() const { return folder_; }

  /// With their plugs goes their power. Buses and chip of lines are there from when they are used first.
  void plug_in_lidar() { lidar.plug_in(); }
  void unplug_lidar() { lidar.unplug(); }
  void plug_in_imu();
  void unplug_imu();
  void plug_in_motors();
  void unplug_motors();
  void plug_in_pins();
  /// Every call fails, as when the chip's driver went.
  void unplug_pins() { pins->fail_with(ENODEV); }

  static constexpr unsigned kEStopLine = 17, kBumperLine = 22;

 private:
  std::string folder_;

 public:
  RunningClock clock;
  DrivenWorld world;
  Bno055Emulator imu;
  ThunderBorgEmulator motors;
  MockI2cBuses buses;
  std::unique_ptr<EmulatedGpioChip> pins;
  RplidarEmulator lidar;

 private:
  bool has_imu_bus_ = false, has_motor_bus_ = false;
};

}  // namespace dynslam::test
