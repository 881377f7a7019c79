// SPDX-License-Identifier: MIT
#include "io/ros_schema.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

namespace dynslam {
namespace {

struct Definition {
  std::string_view type, fields;
};

constexpr std::array kDefinitions = {
    Definition{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    Definition{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    Definition{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    Definition{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    Definition{"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    Definition{"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    Definition{"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    Definition{"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    Definition{"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    Definition{"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    Definition{"geometry_msgs/TwistStamped", "std_msgs/Header header\ngeometry_msgs/Twist twist\n"},
    Definition{"geometry_msgs/Transform",
               "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    Definition{"geometry_msgs/TransformStamped",
               "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    Definition{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    Definition{"sensor_msgs/LaserScan",
               "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
               "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
               "float32[] ranges\nfloat32[] intensities\n"},
    Definition{"sensor_msgs/Imu",
               "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
               "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
               "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
               "float64[9] linear_acceleration_covariance\n"},
    Definition{"sensor_msgs/BatteryState",
               "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\n"
               "float32 charge\nfloat32 capacity\nfloat32 design_capacity\nfloat32 percentage\n"
               "uint8 power_supply_status\nuint8 power_supply_health\nuint8 power_supply_technology\n"
               "bool present\nfloat32[] cell_voltage\nfloat32[] cell_temperature\nstring location\n"
               "string serial_number\n"},
    Definition{"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    Definition{"nav_msgs/Odometry",
               "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
               "geometry_msgs/TwistWithCovariance twist\n"},
    Definition{"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    Definition{"nav_msgs/MapMetaData",
               "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
               "geometry_msgs/Pose origin\n"},
    Definition{"nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
    Definition{"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
    Definition{"diagnostic_msgs/DiagnosticStatus",
               "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\nstring message\n"
               "string hardware_id\ndiagnostic_msgs/KeyValue[] values\n"},
    Definition{"diagnostic_msgs/DiagnosticArray",
               "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n"},
    Definition{"rcl_interfaces/Log",
               "byte DEBUG=10\nbyte INFO=20\nbyte WARN=30\nbyte ERROR=40\nbyte FATAL=50\n"
               "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\n"
               "string function\nuint32 line\n"},
};

std::string_view fields_of(std::string_view type) {
  const auto it = std::find_if(kDefinitions.begin(), kDefinitions.end(),
                               [&](const Definition& d) { return d.type == type; });
  if (it == kDefinitions.end()) throw std::logic_error("no definition of " + std::string(type));
  return it->fields;
}

/// The types within `fields` that have fields themselves, each once, outer ones first.
void find_types(std::string_view fields, std::vector<std::string_view>& types) {
  while (!fields.empty()) {
    std::string_view type = fields.substr(0, fields.find(' '));
    fields.remove_prefix(fields.find('\n') + 1);
    type = type.substr(0, type.find('['));
    const bool is_known = std::find(types.begin(), types.end(), type) != types.end();
    if (type.find('/') == std::string_view::npos || is_known) continue;
    types.push_back(type);
    find_types(fields_of(type), types);
  }
}

}  // namespace

std::string ros_schema(std::string_view type) {
  const std::string_view fields = fields_of(type);
  std::vector<std::string_view> types;
  find_types(fields, types);
  std::string text(fields);
  for (const std::string_view inner : types)
    text += std::string(80, '=') + "\nMSG: " + std::string(inner) + '\n' + std::string(fields_of(inner));
  return text;
}

}  // namespace dynslam
