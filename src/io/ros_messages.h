// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "base/imu_sample.h"
#include "base/odometry.h"
#include "base/scan.h"
#include "io/byte_cursor.h"
#include "io/tf_tree.h"

namespace dynslam {

/// std_msgs/Header. The name points into the message.
struct RosHeader {
  Time stamp;
  std::string_view frame_id;
};

template <class T>
struct RosMessage {
  RosHeader header;
  T value;
};

/// sensor_msgs/LaserScan. Nothing if it is cut off, its angles or times cannot be a lidar's, or it has more
/// than kMaxBeams. Stamp as in the header, mount not set.
std::optional<RosMessage<Scan>> decode_laser_scan(Bytes cdr);

enum class ImuFault { kNone, kUndecodable, kNoOrientation, kBadQuaternion };

/// The counter for it.
std::string_view name_of(ImuFault fault);

/// sensor_msgs/Imu. `value` is the orientation of the IMU's frame, unit length if `fault` is kNone.
RosMessage<Eigen::Quaterniond> decode_imu(Bytes cdr, ImuFault& fault);

/// nav_msgs/Odometry, projected to the plane. Nothing if it is cut off or not finite, or turned by no unit
/// quaternion.
std::optional<RosMessage<Pose2>> decode_odometry(Bytes cdr);

/// tf2_msgs/TFMessage into the tree. False if a part could not be taken.
bool decode_transforms(Bytes cdr, TfTree& tree);

}  // namespace dynslam
