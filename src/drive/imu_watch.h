// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/imu_sample.h"
#include "drive/finding.h"
#include "drive/safety_config.h"

namespace dynslam {

/// Whether the robot stands upright, and whether the IMU can still tell. A robot may have none; one that had
/// a working IMU and lost it goes slowly. Tilt must last before it is believed, and so must its end, as
/// samples may be spikes; a robot whose IMU falls silent while tilted stays so.
class ImuWatch {
 public:
  explicit ImuWatch(const SafetyConfig& config)
      : timeout_(from_seconds(config.imu_timeout_s)),
        tilt_time_(from_seconds(config.tilt_s)),
        tilt_limit_rad_(config.tilt_limit_rad) {}

  /// `imu` is the newest sample, `exists` says that there is an IMU, though it may never have spoken,
  /// `moving` whether the robot is driven. Returns the worst of both rows.
  Finding update(Time now, const std::optional<ImuSample>& imu, bool exists, bool moving);
  void clock_went_back();

  /// Whether the IMU was there and does not tell any more.
  bool is_lost() const { return lost_; }

 private:
  bool is_news(Time now, const ImuSample& imu) const;
  void take(const ImuSample& imu);
  Finding lost(Time now);

  Duration timeout_, tilt_time_;
  double tilt_limit_rad_;
  std::optional<ImuSample> newest_;     ///< valid
  std::optional<Time> heard_;           ///< the newest valid stamp, or when the first nonsense came
  std::optional<Time> contrary_since_;  ///< samples say otherwise than tilted_ since then
  Time same_since_;                     ///< the orientation did not change by a bit, though the robot moved
  bool tilted_ = false, frozen_ = false, lost_ = false;
  double tilt_rad_ = 0.0;
};

}  // namespace dynslam
