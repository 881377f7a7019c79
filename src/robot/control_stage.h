// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "device/devices.h"
#include "drive/drive_control.h"
#include "robot/attitude_track.h"
#include "robot/ports.h"

namespace dynslam {

/// The 50 Hz tick between commands and motors: takes the newest of everything, lets DriveControl decide, and
/// drives. Never waits for anything but the motor board and the pins. One thread.
class ControlStage {
 public:
  static constexpr Duration kTick = std::chrono::milliseconds(20);

  /// `motors` and `pins` may be null: then there is nothing to drive, or no e-stop. With `has_imu` one is to
  /// speak in `imu`. All must outlive this.
  ControlStage(Motors* motors, Pins* pins, const DriveConfig& config, const Clock& clock, Ports& ports,
               const Latest<ImuSample>& imu, bool has_imu);

  /// One tick, now.
  void turn();
  /// When the next is due: a tick later, or when the driver's heartbeat runs out.
  Time due() const { return due_; }
  /// Stands still, whatever the board says to that. The last thing that is driven.
  void halt();

  const DriveControl& control() const { return control_; }

 private:
  void read_motors(Time now);
  void read_pins(Time now);
  /// Whether the board took it; it always does where there is none.
  bool drive(const WheelPower& power);
  DriveState drive_state(Time now, const DriveOutput& out);

  Motors* motors_;
  Pins* pins_;
  const Clock& clock_;
  Ports& ports_;
  const Latest<ImuSample>& imu_;
  DriveControl control_;
  DriveInputs inputs_;
  AttitudeTrack attitude_;
  std::optional<DriveCommand> answered_;
  Time answered_at_;
  Time due_, motors_due_, counters_due_;
  HealthKeeper motors_health_, pins_health_;
};

}  // namespace dynslam
