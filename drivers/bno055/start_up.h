// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/bno055/bno055_config.h"
#include "drivers/bno055/calibration_profile.h"
#include "drivers/bno055/protocol.h"
#include "drivers/i2c/i2c_device.h"
#include "pipe/clock.h"

namespace dynslam::bno055 {

/// Sleeps until the robot's clock says `t`.
void wait_until(const Clock& clock, Time t);

/// Brings the chip from whatever state to fusing with our settings, which takes about a second of waiting:
/// step by step, so that nobody is kept longer than he wants to be. One thread.
class StartUp {
 public:
  StartUp(const Bno055Config& config, const Clock& clock, I2cDevice& chip);

  /// Goes on until the chip fuses, and returns true, or until the clock says `until`. Throws DeviceError when
  /// it cannot be; it is tried from the start again, 0.2 s later at the earliest.
  bool go_on(Time until);
  /// From the start again, with a reset.
  void restart();
  /// Leaves fusion for a moment to read what profile the chip found, which then is profile().
  void read_profile_again();

  bool is_done() const { return step_ == Step::kDone; }
  /// How often fusion began: its heading begins anew each time.
  int beginnings() const { return beginnings_; }
  const Identity& identity() const { return identity_; }
  /// As fusion began.
  const Status& status() const { return status_; }
  std::uint8_t mode() const { return config_.use_compass ? kNdofMode : kImuMode; }

  /// What is written to the chip after a reset, if anything.
  const std::optional<Profile>& profile() const { return profile_; }
  void set_profile(const std::optional<Profile>& profile) { profile_ = profile; }

 private:
  enum class Step {
    kIdentify,
    kReset,
    kAwaitChip,
    kLeaveFusion,
    kSetUp,
    kReadProfile,
    kBeginFusion,
    kAwaitFusion,
    kSettle,
    kDone
  };

  void take_step();
  void next(Step step, Duration pause);
  void identify();
  void reset();
  void await_chip();
  void leave_fusion();
  void set_up();
  void write_profile();
  void read_profile();
  void begin_fusion();
  void await_fusion();
  void set(std::uint8_t reg, std::span<const std::uint8_t> values);
  void must(int error) const {
    if (error) throw chip_.failure(error);
  }

  const Bno055Config config_;
  const Clock& clock_;
  I2cDevice& chip_;
  Step step_ = Step::kIdentify;
  bool wants_profile_ = false;  ///< to read it, not to set the chip up
  Time due_, deadline_;
  int beginnings_ = 0;
  Identity identity_;
  Status status_;
  std::optional<Profile> profile_;
};

}  // namespace dynslam::bno055
