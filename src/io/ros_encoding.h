// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "base/battery_state.h"
#include "base/imu_sample.h"
#include "base/jpeg_frame.h"
#include "base/log_line.h"
#include "base/pose2.h"
#include "base/scan.h"
#include "base/twist.h"
#include "grid/trinary_map.h"

/// Messages of ROS 2 in CDR: what ros_messages.h takes apart, and more.
namespace dynslam {

/// sensor_msgs/LaserScan, see ScanFan. The mount is not in it.
std::string encode_laser_scan(const Scan& scan, std::string_view frame);

/// sensor_msgs/Imu: the orientation; speeds and accelerations are marked as not there.
std::string encode_imu(const ImuSample& sample, std::string_view frame);

/// A frame that sits on another.
struct RosTransform {
  Time stamp;
  std::string_view parent, child;
  Pose2 parent_T_child;
  double z_m = 0.0;
  bool upside_down = false;  ///< then rolled by pi about its x axis
};

/// tf2_msgs/TFMessage.
std::string encode_transforms(std::span<const RosTransform> transforms);

/// nav_msgs/Odometry of `base_link` in `frame`. `covariance` as in PoseEstimate.
std::string encode_odometry(std::string_view frame, Time stamp, const Pose2& frame_T_robot,
                            const Eigen::Matrix3d& covariance, const Twist& twist);

/// nav_msgs/Path of points in `map`; the poses' headings mean nothing.
std::string encode_path(Time stamp, std::span<const Vector2> points_map);

/// geometry_msgs/TwistStamped.
std::string encode_twist(Time stamp, const Twist& twist);

/// sensor_msgs/BatteryState.
std::string encode_battery(Time stamp, const BatteryState& battery);

/// nav_msgs/OccupancyGrid.
std::string encode_grid(Time stamp, const TrinaryMap& map);

/// sensor_msgs/CompressedImage.
std::string encode_image(const JpegFrame& frame);

/// diagnostic_msgs/DiagnosticStatus.
struct DiagnosticStatus {
  enum class Level : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };
  Level level = Level::kOk;
  std::string name, message;
  std::vector<std::pair<std::string, std::string>> values = {};
};

/// diagnostic_msgs/DiagnosticArray.
std::string encode_diagnostics(Time stamp, std::span<const DiagnosticStatus> statuses);

/// rcl_interfaces/Log, of the logger `name`.
std::string encode_log(const LogLine& line, std::string_view name);

}  // namespace dynslam
