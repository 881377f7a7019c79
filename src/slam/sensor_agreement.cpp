// SPDX-License-Identifier: MIT
#include "slam/sensor_agreement.h"

#include <cmath>

namespace dynslam {

void SensorAgreement::Products::add(double map, double other) {
  constexpr double kKept = 0.995;
  map_map = kKept * map_map + map * map;
  map_other = kKept * map_other + map * other;
  other_other = kKept * other_other + other * other;
}

/// Enough motion was seen by both, and their signs go against each other far more often than by chance.
bool SensorAgreement::Products::is_opposite(double least) const {
  constexpr double kClearly = -0.7;
  return map_map > least && other_other > least && map_other < kClearly * std::sqrt(map_map * other_other);
}

void SensorAgreement::note(const Pose2& by_map, std::optional<double> imu_turn_rad,
                           const std::optional<Pose2>& by_wheels) {
  if (imu_turn_rad) {
    constexpr double kNextToNone = 0.05;
    const bool alone = std::abs(*imu_turn_rad) < kNextToNone * std::abs(by_map.yaw);
    turned_alone_rad2_ = alone ? turned_alone_rad2_ + by_map.yaw * by_map.yaw : 0.0;
    imu_turn_.add(by_map.yaw, *imu_turn_rad);
  }
  if (!by_wheels) return;
  wheel_turn_.add(by_map.yaw, by_wheels->yaw);
  wheel_way_.add(by_map.x, by_wheels->x);
}

std::vector<std::string> SensorAgreement::findings() const {
  std::vector<std::string> all;
  if (imu_turns_backwards())
    all.emplace_back(
        "the IMU turns the other way than the lidar: one of them sits upside down or has its axes mirrored "
        "(lidar.upside_down); its heading is not used");
  if (imu_hangs())
    all.emplace_back("the IMU does not turn with the robot: it hangs; its heading is not used");
  if (wheels_turn_backwards())
    all.emplace_back(
        "the wheels turn the other way than the lidar: left and right are swapped, or the lidar sits upside "
        "down (lidar.upside_down); the wheels are not used");
  if (wheels_drive_backwards())
    all.emplace_back(
        "the wheels drive the other way than the lidar: the lidar sits backwards (lidar.yaw_rad 3.1416), or "
        "the "
        "wheels count backwards; they are not used");
  return all;
}

}  // namespace dynslam
