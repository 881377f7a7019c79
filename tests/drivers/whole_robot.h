// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json_fwd.hpp>

#include "drivers/emulated_hardware.h"
#include "robot/robot.h"

namespace dynslam::test {

/// A person at the stick: commands twenty times a second, and lets go while the robot is stopped. A thread of
/// its own.
class Hand {
 public:
  using Wish = std::function<Twist(Time now, const PoseEstimate& pose, const Verdict& verdict)>;

  /// `wish` is called by its thread. Both others must outlive it.
  Hand(Ports& ports, const Clock& clock, Wish wish);

 private:
  void run(const std::stop_token& stop);

  Ports& ports_;
  const Clock& clock_;
  Wish wish_;
  std::jthread thread_;
};

/// The robot as `dynslam run` makes it, its threads and its real drivers, on emulated hardware.
class WholeRobot : public ::testing::Test {
 protected:
  void begin(const World& world, EmulatedHardware::Plugged plugged = EmulatedHardware::Plugged::kAll);
  /// To be changed before start().
  Config& config() { return config_; }
  /// `wrap` may put something around a device.
  void start(const std::function<void(Devices&)>& wrap = {});
  /// From now on somebody holds the stick so.
  void hold(const Twist& twist);
  void drive_by(Hand::Wish wish);
  void let_go() { hand_.reset(); }
  void TearDown() override;

  EmulatedHardware& hardware() { return *hardware_; }
  Robot& robot() { return *robot_; }
  Ports& ports() { return robot_->ports(); }
  Time now() const { return hardware_->clock.now(); }

  /// Waits for it, `seconds` at most; returns how long that took, and nothing when it never came true.
  std::optional<double> comes_true(double seconds, const std::function<bool()>& what);
  DriveState drive();
  /// The page's words: what /api/v1/devices says of a device.
  nlohmann::json device(const std::string& name);
  std::string trouble(const std::string& name);
  bool goes();    ///< may move, and does
  bool stands();  ///< in truth
  /// For messages: what it does and how its devices are.
  std::string state();

 private:
  std::unique_ptr<EmulatedHardware> hardware_;
  Config config_;
  std::unique_ptr<Robot> robot_;
  // No optional: GCC 14 believes that one is used before it is made.
  std::unique_ptr<Hand> hand_;
};

}  // namespace dynslam::test
