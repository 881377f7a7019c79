// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "base/pose2.h"
#include "base/scan.h"

namespace dynslam {

/// How far one sees in each direction from the lidar, seen from above.
class Sight {
 public:
  static constexpr std::size_t kSectors = 120;

  /// At the end of a scan, during which the robot turned by so much.
  Sight(const Scan& scan, double turned_rad);

  /// Of a direction, of a place from the lidar.
  static std::size_t sector_of(double angle_rad);
  static std::size_t sector_of(const Vector2& from_lidar);
  static double middle_rad(std::size_t sector);

  /// 0 where nothing comes back. Sectors are counted on round the circle.
  double farthest_m(std::size_t sector) const { return farthest_m_[sector % kSectors]; }

 private:
  std::array<double, kSectors> farthest_m_{};
};

/// A scan that has just come: what one sees, and how the robot moved since the one before; nothing: nobody
/// knows.
struct Look {
  Time end;  ///< of the scan
  Pose2 robot_T_lidar;
  Sight sight;
  std::optional<Pose2> before_T_now;
};

}  // namespace dynslam
