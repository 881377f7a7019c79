// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "base/odometry.h"

namespace dynslam {

/// The last seconds of wheel odometry, interpolated at any time in between. One thread.
class OdometryTrack {
 public:
  /// Of two samples with one stamp the later counts; samples from the past are dropped and counted.
  void add(const OdometrySample& sample);

  bool empty() const { return samples_.empty(); }
  /// REQUIRES: !empty().
  Time newest() const { return samples_.back().stamp; }

  /// odom_T_robot; nothing before the oldest kept or later than kCarryOn after the newest (which is then
  /// taken as it is).
  std::optional<Pose2> pose_at(Time t) const;

  std::uint64_t out_of_order() const { return out_of_order_; }

  static constexpr Duration kKept = std::chrono::seconds(30);
  static constexpr Duration kCarryOn = std::chrono::milliseconds(100);

 private:
  std::deque<OdometrySample> samples_;
  std::uint64_t out_of_order_ = 0;
};

}  // namespace dynslam
