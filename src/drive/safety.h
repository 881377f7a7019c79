// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/battery_state.h"
#include "drive/bumper_watch.h"
#include "drive/clearance.h"
#include "drive/estop_latch.h"
#include "drive/imu_watch.h"
#include "drive/motor_watch.h"
#include "drive/scan_watch.h"

namespace dynslam {

/// The newest of everything, and what is about to be driven.
struct SafetyInputs {
  Twist twist;                                ///< finite; what is driven if nothing speaks against it
  std::optional<std::string> driver_missing;  ///< why nobody drives
  std::shared_ptr<const Scan> scan;           ///< null: none yet
  bool has_imu = false;                       ///< there is one, though it may not have spoken yet
  std::optional<ImuSample> imu;
  std::optional<Stamped<MotorState>> motors;
  bool has_estop = false;  ///< there is one, though it may not have been read yet
  std::optional<Stamped<PinState>> pins;
  std::optional<std::string> stop_asked;  ///< by whom or why; needed for one tick only
  bool clear_asked = false;               ///< a person clears stops, for one tick
  BatteryState battery;
  double battery_power = 1.0;  ///< what brownouts leave of the power
};

/// What may be driven.
struct Decision {
  Finding worst;       ///< the first one of the worst
  double share = 0.0;  ///< of the twist; exactly 0 from kHold on
};

/// Has the last word on motion: a table of rows, each a finding from time, its own small state and the newest
/// inputs; the worst wins. Reads no clock: a clock that runs backwards stops the robot, and what was known is
/// forgotten, except for what is latched. Called every tick, 50 times a second; one thread.
class Safety {
 public:
  Safety(const SafetyConfig& config, const BodyConfig& body, const ClearanceConfig& clearance);

  Decision decide(Time now, const SafetyInputs& in);
  /// What came of it: this is driven from `now` on.
  void driven(Time now, const Twist& twist, const WheelPower& power, const std::optional<ImuSample>& imu);

 private:
  Finding clock(Time now);
  Finding obstacle(Time now, const ClearWay& way, const Twist& twist);
  Finding battery(const SafetyInputs& in) const;
  double careful_share(const SafetyInputs& in) const;

  SafetyConfig config_;
  EStopLatch estop_;
  StopLatch stop_;
  MotorWatch motors_;
  ScanWatch scans_;
  ImuWatch imu_;
  BumperWatch bumpers_;
  Clearance clearance_;
  RecentMotion motion_;
  std::shared_ptr<const Scan> seen_;  ///< the scan that clearance_ goes by
  Finding slowed_;                    ///< the last time an obstacle slowed the robot down
  Time slowed_at_;
  std::optional<Time> now_;
  Twist twist_;
  WheelPower power_;
};

}  // namespace dynslam
