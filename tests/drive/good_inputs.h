// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <random>

#include "drive/drawn_scan.h"
#include "drive/drive_control.h"

namespace dynslam {

/// What a healthy robot in an empty yard of 20 x 20 m reads, at any time; a scan every 100 ms, 50 ms old when
/// it comes.
class HealthyRobot {
 public:
  std::shared_ptr<const Scan> scan(Time now) {
    const Time stamp = begin_of_scan(now);
    if (!scan_ || scan_->stamp != stamp) scan_ = shaken(drawn_, stamp, random_);
    return scan_;
  }
  /// Level, with the noise of a sample.
  ImuSample imu(Time now) {
    std::uniform_real_distribution<double> noise(-1e-3, 1e-3);
    return {now, Eigen::Quaterniond(1.0, noise(random_), noise(random_), noise(random_)).normalized()};
  }
  static Stamped<MotorState> motors(Time now) { return {now, {12.5, false, false, true}}; }
  static Stamped<PinState> pins(Time now) { return {now, {}}; }

 private:
  static Time begin_of_scan(Time now) {
    const Duration period = std::chrono::milliseconds(100);
    const Duration since = now.time_since_epoch() - std::chrono::milliseconds(50);
    return Time(since - since % period);
  }
  Scan drawn_ = scan_of(
      {{{-10, -10, 10, -10}, {10, -10, 10, 10}, {10, 10, -10, 10}, {-10, 10, -10, -10}}, {}}, {}, 100);
  std::mt19937 random_{7};
  std::shared_ptr<const Scan> scan_;
};

inline Eigen::Quaterniond leaning(double degrees, const Eigen::Vector3d& about = Eigen::Vector3d::UnitY()) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(radians(degrees), about));
}

}  // namespace dynslam
