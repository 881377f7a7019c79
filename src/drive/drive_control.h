// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "drive/battery_watch.h"
#include "drive/drive_config.h"
#include "drive/heartbeat.h"
#include "drive/kinematics.h"
#include "drive/safety.h"
#include "drive/speed_ramp.h"

namespace dynslam {

/// The newest of everything that driving needs; what did not change is given again.
struct DriveInputs {
  std::optional<DriveCommand> command;  ///< a person's or the autopilot's
  bool driver_left = false;             ///< somebody who drove is gone; the command is not older than that
  std::shared_ptr<const Scan> scan;
  bool has_imu = false;  ///< there is one, though it may not have spoken yet
  std::optional<ImuSample> imu;
  std::optional<Stamped<MotorState>> motors;  ///< as last read
  bool supply_low = false;                    ///< the computer's own, as it said last
  bool has_estop = false;                     ///< there is one, though it may not have been read yet
  std::optional<Stamped<PinState>> pins;
  double power_limit = 1.0;               ///< the user's, 0 to 1: scales what is commanded
  std::optional<std::string> stop_asked;  ///< by whom or why; one tick is enough
  bool clear_asked = false;               ///< a person clears stops; for one tick
};

struct DriveOutput {
  WheelPower power;  ///< for Motors::drive()
  Verdict verdict;
  Cause cause = Cause::kNone;    ///< of the verdict
  Twist applied;                 ///< what that power drives
  BatteryState battery;          ///< as shown
  bool battery_changed = false;  ///< since the last tick: worth telling
};

/// From a command to the wheels: the dead man's switch, the power limits, the acceleration limits, Safety and
/// the kinematics, in this order. The power is exactly zero while the verdict is Stop or EStop, and after it
/// until the driver let go and pushed again; the autopilot says "stand still" while it is stopped.
class DriveControl {
 public:
  struct Transition {
    Time time;
    Verdict verdict;
  };
  static constexpr std::size_t kMostTransitions = 100;

  explicit DriveControl(const DriveConfig& config = {});

  /// One tick, every 20 ms and at deadline(). REQUIRES: `now` was read after the inputs were taken. Takes any
  /// input and any time that is_representable_s(); a `now` before the last one stops the robot.
  DriveOutput step(Time now, const DriveInputs& in);

  /// When the driver will be lost if nothing more is heard: the next step() should not be later.
  std::optional<Time> deadline() const { return heartbeat_.deadline(); }
  /// Changes of the verdict's kind or cause, oldest first; the last hundred.
  const std::deque<Transition>& transitions() const { return transitions_; }
  /// Commands that were refused, by reason.
  const Counters& refused() const { return heartbeat_.refused(); }

 private:
  bool watch_battery(Time now, const DriveInputs& in);
  Twist wanted(const DriveInputs& in) const;
  SafetyInputs safety_inputs(const DriveInputs& in, const Twist& twist) const;
  void log(Time now, const Finding& worst);

  Heartbeat heartbeat_;
  BatteryWatch battery_;
  Kinematics kinematics_;
  SpeedRamp ramp_;
  Safety safety_;
  std::optional<Time> now_;
  std::optional<Time> battery_read_;  ///< the stamp of the last reading taken
  std::deque<Transition> transitions_;
  std::optional<Cause> cause_;  ///< of the last transition
};

}  // namespace dynslam
