// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "base/pose2.h"
#include "base/time.h"
#include "grid/chunked_grid.h"

namespace dynslam {

/// A local map lives for some seconds, too short for the building to change: what counts is that a wall's
/// cells tell how often each was hit, so they fill up slowly and forget little. Measured: errors halve
/// against the global map's rule.
inline constexpr CellRule kLocalMapRule{.gain = 10, .loss = 3};

/// What is known of where a robot is that was lost: next to nothing.
inline constexpr double kLost_m = 20.0;
inline constexpr double kLost_rad = 1.5;

/// A piece of the building as seen over a few dozen scans, short enough to have no drift worth speaking of.
/// Its cells are drawn in the frame that poses were given in when it was begun; `map_T_origin` is the robot's
/// pose then and there.
struct LocalMap {
  LocalMap(double cell_size_m, std::size_t max_chunks, const Pose2& origin, Time begin)
      : grid(cell_size_m, max_chunks, kLocalMapRule),
        map_T_origin(origin),
        begun(begin),
        robot_positions{origin.translation()} {}

  ChunkedGrid grid;
  std::uint32_t id = 0;  ///< counted up
  Pose2 map_T_origin;
  /// Of map_T_origin, as the map before this one told it: m2, m rad, rad2. Of a map that is not tied, what is
  /// known of a robot that was lost.
  Eigen::Matrix3d origin_covariance = Eigen::Matrix3d::Zero();
  bool is_tied = false;                   ///< begun at a scan that was matched against the map before
  std::optional<double> imu_heading_rad;  ///< when it was begun, continuous
  Time begun, ended;
  int scans = 0;                         ///< that count: taken in motion
  double travel_m = 0.0;                 ///< since it was begun
  std::vector<Vector2> robot_positions;  ///< where scans that count were taken, in the frame it is drawn in
};

}  // namespace dynslam
