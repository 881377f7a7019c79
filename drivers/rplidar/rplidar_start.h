// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/rplidar/device_talk.h"
#include "drivers/rplidar/mode_survey.h"
#include "drivers/rplidar/rplidar_config.h"

namespace dynslam::rplidar {

/// What a lidar says of itself, as far as it was asked.
struct Portrait {
  std::string port;
  int baud = 0;
  std::optional<DeviceInfo> info;
  std::optional<Health> health;
  std::vector<ScanMode> modes;   ///< that can be decoded
  std::optional<ScanMode> mode;  ///< the chosen one
};

/// Leads a lidar from its port to its first packet: finds port and baud rate, asks for model, health and
/// modes, spins it up, and lets it measure. Goes on where it stopped when time was up. One thread.
class Start {
 public:
  Start(RplidarConfig config, const Clock& clock) : config_(std::move(config)), clock_(clock), talk_(clock) {}

  /// Until all is known that it says of itself. False: not by `until`. Throws DeviceError.
  bool identify(Time until) { return advance(Phase::kMotor, until); }
  /// Until it measures.
  bool measure(Time until) { return advance(Phase::kMeasuring, until); }
  /// Stops lidar and motor, as far as they listen, and closes the port: it will begin anew.
  void stop() noexcept;

  const Portrait& portrait() const { return portrait_; }
  DeviceTalk& talk() { return talk_; }
  /// How it measures. REQUIRES: measure() said so.
  AnswerType answer() const { return answer_; }

 private:
  enum class Phase { kClosed, kQuieting, kAsking, kHealth, kResetting, kModes, kMotor, kScan, kMeasuring };
  enum class Motor { kUnknown, kDtr, kPwm, kRpm };
  static Motor motor_of(const DeviceInfo& info);
  struct Way {
    std::string port;
    int baud;
  };

  bool advance(Phase goal, Time until);
  bool step(Time until);
  std::vector<Way> ways() const;
  bool open();
  bool ask_motor(Time until);
  bool ask_info(Time until);
  bool ask_health(Time until);
  bool reset(Time until);
  bool ask_modes(Time until);
  bool choose();
  bool start_motor(Time until);
  bool start_scan(Time until);
  void turn_motor(bool on);
  bool go(Phase next);

  RplidarConfig config_;
  const Clock& clock_;
  DeviceTalk talk_;
  Portrait portrait_;
  Phase phase_ = Phase::kClosed;
  std::vector<Way> ways_;  ///< left to be tried
  std::string tried_;
  std::optional<Way> known_;  ///< where it answered before
  bool was_reset_ = false;
  ModeSurvey survey_;
  Motor motor_ = Motor::kUnknown;
  AnswerType answer_{};
};

}  // namespace dynslam::rplidar
