// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/attitude.h"
#include "base/imu_sample.h"

namespace dynslam {

/// From the IMU's newest samples to how the robot stands and turns, to be shown. One thread.
class AttitudeTrack {
 public:
  /// Takes in the newest sample, or the same again. Nothing comes back when there was none for a second, or
  /// none that makes sense.
  std::optional<Attitude> update(Time now, const std::optional<ImuSample>& newest);

 private:
  void take(const ImuSample& sample);

  std::optional<ImuSample> newest_;  ///< that makes sense
  std::optional<ImuSample> before_;  ///< the turn is measured from it
  double yaw_radps_ = 0.0;
};

}  // namespace dynslam
