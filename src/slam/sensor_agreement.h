// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/pose2.h"

namespace dynslam {

/// Whether the motion sensors mean the same directions as the lidar. Mounting one the wrong way round is the
/// mistake that every new user makes; it shows as motion of the same size with the opposite sign. A sensor
/// that hangs shows as no motion at all. Judged over the last ten to twenty seconds of motion. One thread.
class SensorAgreement {
 public:
  /// From one matched scan to the next, in the robot's frame: as the map says, as the IMU turned, as the
  /// wheels went.
  void note(const Pose2& by_map, std::optional<double> imu_turn_rad, const std::optional<Pose2>& by_wheels);

  bool imu_turns_backwards() const { return imu_turn_.is_opposite(kTurns_rad2); }
  bool imu_hangs() const { return turned_alone_rad2_ > kAlone_rad2; }
  bool wheels_turn_backwards() const { return wheel_turn_.is_opposite(kTurns_rad2); }
  bool wheels_drive_backwards() const { return wheel_way_.is_opposite(kWays_m2); }

  /// What is wrong, in words for the user; empty when nothing is.
  std::vector<std::string> findings() const;

 private:
  /// Sums of the products of two measurements of one motion.
  struct Products {
    double map_map = 0.0, map_other = 0.0, other_other = 0.0;
    void add(double map, double other);
    bool is_opposite(double least) const;
  };
  static constexpr double kTurns_rad2 = 0.06;  ///< 24 scans at 0.05 rad
  static constexpr double kWays_m2 = 0.06;     ///< 150 scans at 2 cm, or 38 at 4 cm

  static constexpr double kAlone_rad2 = 0.03;  ///< 12 scans at 0.05 rad

  double turned_alone_rad2_ = 0.0;  ///< what the map saw since the IMU last turned with it
  Products imu_turn_, wheel_turn_, wheel_way_;
};

}  // namespace dynslam
