// SPDX-License-Identifier: MIT
#pragma once

#include "base/imu_sample.h"
#include "sim/outbox.h"
#include "sim/random_stream.h"
#include "sim/robot_body.h"

namespace dynslam {

/// A BNO055 in its IMU mode: 100 fused orientations a second, with a heading that starts anywhere and drifts,
/// mounted not quite level. What it says at its stamp was true some milliseconds before; now and then a
/// single sample is wide off.
class ImuModel {
 public:
  ImuModel(Time begin, std::uint64_t seed);

  /// REQUIRES: called every kPeriod; `late` is where the robot was kLag before `now`.
  void measure(Time now, const BodyPose& late, Outbox<ImuSample>& out);
  Time next_due() const { return next_ + kDelivery; }

  static constexpr Duration kPeriod = std::chrono::milliseconds(10);
  static constexpr Duration kLag = std::chrono::milliseconds(6);  ///< of the orientation behind the stamp
  static constexpr Duration kDelivery = std::chrono::milliseconds(4);  ///< over the bus

 private:
  RandomStream random_;
  Time next_;
  double heading_off_rad_;
  double drift_radps_;
  Eigen::Quaterniond robot_q_chip_;
};

}  // namespace dynslam
