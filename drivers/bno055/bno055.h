// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <string>

#include "base/counters.h"
#include "device/imu.h"
#include "drivers/bno055/bno055_config.h"
#include "drivers/bno055/calibration_profile.h"
#include "drivers/bno055/motion_check.h"
#include "drivers/bno055/protocol.h"
#include "drivers/bno055/start_up.h"
#include "drivers/i2c/i2c_device.h"
#include "pipe/clock.h"

namespace dynslam {

/// What the chip is and how it is doing.
struct Bno055Report {
  bool running = false;
  bno055::Identity identity;
  bno055::Status status;     ///< asked for as it begins, then once a second
  bno055::Motion motion;     ///< the newest that was believed; its heading is the chip's own
  bool has_profile = false;  ///< of its calibration, that it was given or has found
  bool on_software_bus = false;
};

/// A BNO055 that fuses gyroscope and accelerometer (its IMU mode), or these and the compass (NDOF). It is
/// read on a steady grid, each sample stamped with when it was read less the chip's own delay; a reading
/// that cannot be is dropped and counted, and after five in a row, or when all stands still, the chip is
/// reset and set up anew. The heading goes on then where it was.
class Bno055 : public Imu {
 public:
  Bno055(const Bno055Config& config, const Clock& clock, ProfileStore store = {});

  std::optional<ImuSample> next(Time until) override;

  /// Any thread.
  std::string about() const override;
  /// Any thread.
  Bno055Report report() const;
  /// Besides those of I2cDevice: "all-zero", "all-ones", "length", "rate", "jump", "late", "skipped",
  /// "status", "frozen", "resets", "readback", "odd-identity", "reset-unheard", "profile-changed",
  /// "profile-refused", "profile-bad", "profile-saved", "profile-unsaved". Any thread.
  Counters counters() const override { return chip_.counters(); }

 private:
  void load_profile();
  void save_profile();
  void begin();
  std::optional<ImuSample> read();
  bool is_sound(Time stamp, const bno055::MotionReading& reading);
  ImuSample join(Time stamp, const Eigen::Quaterniond& chip_q_robot);
  void schedule(Time now);

  void look_after(Time now);
  std::optional<bno055::Status> read_status();
  void watch_freezing();
  bool is_calibrated(const bno055::Calibration& calibration) const;
  [[noreturn]] void give_up(const DeviceError& why);

  const Bno055Config config_;
  const Clock& clock_;
  const ProfileStore store_;
  I2cDevice chip_;
  bno055::StartUp start_up_;
  int beginning_ = 0;  ///< of the start-up, that all below goes by

  Duration period_{};
  Time due_, status_due_;
  Duration quickest_{};  ///< of the readings
  bno055::MotionCheck check_;
  int bad_readings_ = 0, bad_statuses_ = 0;  ///< in a row
  Time turned_;                              ///< when the robot last did
  std::optional<int> temperature_c_;
  std::optional<std::string> profile_kept_;
  bool profile_found_ = false;  ///< in this life

  std::optional<double> heading_rad_;  ///< handed out last
  double heading_off_rad_ = 0.0;       ///< from the chip's
  bool joins_ = false;                 ///< the chip's heading began anew

  bno055::MotionBytes newest_{};
  bool changed_ = true;  ///< newest_ did, since the last look at the acceleration
  std::array<std::uint8_t, 6> acceleration_{};
  int frozen_looks_ = 0;

  mutable std::mutex report_mutex_;
  Bno055Report report_;
};

}  // namespace dynslam
