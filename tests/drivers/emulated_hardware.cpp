// SPDX-License-Identifier: MIT
#include "drivers/emulated_hardware.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace dynslam::test {
namespace {

constexpr int kMotorBus = 1, kImuBus = 3, kMotorAddress = 0x15, kImuAddress = 0x28;

std::string new_folder() {
  std::string name = std::filesystem::temp_directory_path() / "robotXXXXXX";
  if (!mkdtemp(name.data())) throw std::runtime_error("no new folder " + name);
  return name;
}

}  // namespace

EmulatedHardware::EmulatedHardware(const World& emulated, Plugged plugged)
    : folder_(new_folder()),
      world(emulated, clock),
      imu([this] { return clock.now(); }, [this] { return world.motion(); }),
      motors([this] { return clock.now(); }),
      lidar(emulated_a3(), clock, folder_ + "/serial",
            [this](double angle_rad, Time when) { return world.range_m(angle_rad, when); }) {
  motors.on_driven([this](double a, double b) { world.drive({a, b}); });
  if (plugged == Plugged::kNothing) {
    lidar.unplug();
    return;
  }
  plug_in_imu();
  plug_in_motors();
  plug_in_pins();
}

EmulatedHardware::~EmulatedHardware() { std::filesystem::remove_all(folder_); }

Config EmulatedHardware::config() const {
  Config config;
  config.hardware.rplidar.port_folder = folder_ + "/serial";
  config.hardware.camera.name = "none";
  config.hardware.gpio.estop_line = kEStopLine;
  config.hardware.gpio.bumper_lines = {std::to_string(kBumperLine)};
  config.state.folder = folder_ + "/state";
  config.recorder.folder = folder_ + "/recordings";
  return config;
}

void EmulatedHardware::plug_in_imu() {
  if (!std::exchange(has_imu_bus_, true)) buses.add_bus(kImuBus, true);
  imu.reset();
  buses.plug(kImuBus, kImuAddress, &imu);
}

void EmulatedHardware::unplug_imu() { buses.plug(kImuBus, kImuAddress, nullptr); }

void EmulatedHardware::plug_in_motors() {
  if (!std::exchange(has_motor_bus_, true)) buses.add_bus(kMotorBus);
  buses.plug(kMotorBus, kMotorAddress, &motors);
}

void EmulatedHardware::unplug_motors() {
  buses.plug(kMotorBus, kMotorAddress, nullptr);
  motors.reset();
}

void EmulatedHardware::plug_in_pins() {
  if (pins) return pins->fail_with(0);
  pins = std::make_unique<EmulatedGpioChip>(buses.bed(), 0, "pinctrl-bcm2835", 54);
}

}  // namespace dynslam::test
