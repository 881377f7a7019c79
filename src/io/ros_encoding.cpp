// SPDX-License-Identifier: MIT
#include "io/ros_encoding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/cdr.h"
#include "io/scan_fan.h"

namespace dynslam {
namespace {

/// Beyond the reach of every lidar that a small robot carries. The reader takes what is farther for nothing.
constexpr float kFarthest_m = 100.0F;
constexpr double kNotThere = -1.0;  // first of a covariance: the field beside it means nothing

void put_time(CdrWriter& cdr, Time stamp) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(stamp.time_since_epoch());
  cdr.put(static_cast<std::int32_t>(seconds.count()));
  cdr.put(static_cast<std::uint32_t>((stamp.time_since_epoch() - seconds).count()));
}

void put_header(CdrWriter& cdr, Time stamp, std::string_view frame) {
  put_time(cdr, stamp);
  cdr.text(frame);
}

void put_quaternion(CdrWriter& cdr, const Eigen::Quaterniond& q) {
  cdr.put_all({q.x(), q.y(), q.z(), q.w()});
}

Eigen::Quaterniond yaw_rotation(double yaw_rad) {
  return {std::cos(0.5 * yaw_rad), 0.0, 0.0, std::sin(0.5 * yaw_rad)};
}

void put_pose(CdrWriter& cdr, const Pose2& pose) {
  cdr.put_all({pose.x, pose.y, 0.0});
  put_quaternion(cdr, yaw_rotation(pose.yaw));
}

void put_twist(CdrWriter& cdr, const Twist& twist) {
  cdr.put_all({twist.v_mps, 0.0, 0.0, 0.0, 0.0, twist.w_radps});
}

/// A 3 x 3 matrix whose first element is `first`, for speeds and forces that nothing measures.
void put_empty(CdrWriter& cdr, double first) {
  cdr.put(first);
  for (int i = 0; i < 8; ++i) cdr.put(0.0);
}

/// Of (x, y, yaw) among (x, y, z, roll, pitch, yaw).
void put_covariance(CdrWriter& cdr, const Eigen::Matrix3d& planar) {
  constexpr int kOfSix[] = {0, 1, -1, -1, -1, 2};
  for (const int row : kOfSix) {
    for (const int column : kOfSix) cdr.put(row < 0 || column < 0 ? 0.0 : planar(row, column));
  }
}

}  // namespace

std::string encode_laser_scan(const Scan& scan, std::string_view frame) {
  const ScanFan fan = to_fan(scan);
  const auto steps = static_cast<float>(std::max<std::size_t>(fan.ranges_m.size(), 1) - 1);
  float farthest = kFarthest_m;
  for (const float range : fan.ranges_m) {
    if (std::isfinite(range) && range >= farthest)
      farthest = std::nextafter(range, std::numeric_limits<float>::infinity());
  }
  CdrWriter cdr;
  put_header(cdr, fan.stamp, frame);
  cdr.put_all({fan.first_rad, fan.first_rad + steps * fan.step_rad, fan.step_rad, fan.time_step_s});
  cdr.put_all({(steps + 1.0F) * fan.time_step_s, 0.0F, farthest});
  return cdr.floats(fan.ranges_m).floats({}).bytes();
}

std::string encode_imu(const ImuSample& sample, std::string_view frame) {
  CdrWriter cdr;
  put_header(cdr, sample.stamp, frame);
  put_quaternion(cdr, sample.world_q_robot);
  put_empty(cdr, 0.0);  // unknown
  for (int i = 0; i < 2; ++i) {
    cdr.put_all({0.0, 0.0, 0.0});
    put_empty(cdr, kNotThere);
  }
  return cdr.bytes();
}

std::string encode_transforms(std::span<const RosTransform> transforms) {
  CdrWriter cdr;
  cdr.put(static_cast<std::uint32_t>(transforms.size()));
  const Eigen::Quaterniond rolled(0.0, 1.0, 0.0, 0.0);
  for (const RosTransform& t : transforms) {
    put_header(cdr, t.stamp, t.parent);
    cdr.text(t.child).put_all({t.parent_T_child.x, t.parent_T_child.y, t.z_m});
    const Eigen::Quaterniond yaw = yaw_rotation(t.parent_T_child.yaw);
    put_quaternion(cdr, t.upside_down ? yaw * rolled : yaw);
  }
  return cdr.bytes();
}

std::string encode_odometry(std::string_view frame, Time stamp, const Pose2& frame_T_robot,
                            const Eigen::Matrix3d& covariance, const Twist& twist) {
  CdrWriter cdr;
  put_header(cdr, stamp, frame);
  cdr.text("base_link");
  put_pose(cdr, frame_T_robot);
  put_covariance(cdr, covariance);
  put_twist(cdr, twist);
  put_covariance(cdr, Eigen::Matrix3d::Zero());
  return cdr.bytes();
}

std::string encode_path(Time stamp, std::span<const Vector2> points_map) {
  CdrWriter cdr;
  put_header(cdr, stamp, "map");
  cdr.put(static_cast<std::uint32_t>(points_map.size()));
  for (const Vector2& point : points_map) {
    put_header(cdr, stamp, "map");
    put_pose(cdr, {point.x(), point.y(), 0.0});
  }
  return cdr.bytes();
}

std::string encode_twist(Time stamp, const Twist& twist) {
  CdrWriter cdr;
  put_header(cdr, stamp, "base_link");
  put_twist(cdr, twist);
  return cdr.bytes();
}

std::string encode_battery(Time stamp, const BatteryState& battery) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const bool is_known = battery.level != BatteryLevel::kUnknown;
  CdrWriter cdr;
  put_header(cdr, stamp, "");
  cdr.put(is_known ? static_cast<float>(battery.voltage_v) : kUnknown);
  for (int i = 0; i < 5; ++i) cdr.put(kUnknown);  // temperature, current, charge, capacity, design capacity
  cdr.put(is_known ? static_cast<float>(battery.share) : kUnknown);
  cdr.put_all<std::uint8_t>({0, 0, 0});          // status, health, technology: unknown
  cdr.put(static_cast<std::uint8_t>(is_known));  // present
  return cdr.floats({}).floats({}).text("").text("").bytes();
}

std::string encode_grid(Time stamp, const TrinaryMap& map) {
  constexpr std::int8_t kValue[] = {-1, 0, 100};  // by CellState
  const Pose2 corner{map.origin.x * map.cell_size_m, map.origin.y * map.cell_size_m, 0.0};
  CdrWriter cdr;
  put_header(cdr, stamp, "map");
  put_time(cdr, stamp);
  cdr.put(static_cast<float>(map.cell_size_m));
  cdr.put_all({static_cast<std::uint32_t>(map.width), static_cast<std::uint32_t>(map.height)});
  put_pose(cdr, corner);
  std::string cells(map.cells.size(), '\0');
  std::transform(map.cells.begin(), map.cells.end(), cells.begin(),
                 [&](CellState state) { return static_cast<char>(kValue[static_cast<std::size_t>(state)]); });
  return cdr.blob(cells).bytes();
}

std::string encode_image(const JpegFrame& frame) {
  CdrWriter cdr;
  put_header(cdr, frame.stamp, "camera_optical");
  cdr.text("jpeg");
  return cdr.blob({reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size()}).bytes();
}

std::string encode_diagnostics(Time stamp, std::span<const DiagnosticStatus> statuses) {
  CdrWriter cdr;
  put_header(cdr, stamp, "");
  cdr.put(static_cast<std::uint32_t>(statuses.size()));
  for (const DiagnosticStatus& status : statuses) {
    cdr.put(static_cast<std::uint8_t>(status.level)).text(status.name).text(status.message).text("dynslam");
    cdr.put(static_cast<std::uint32_t>(status.values.size()));
    for (const auto& [key, value] : status.values) cdr.text(key).text(value);
  }
  return cdr.bytes();
}

std::string encode_log(const LogLine& line, std::string_view name) {
  CdrWriter cdr;
  put_time(cdr, line.time);
  cdr.put(static_cast<std::uint8_t>(line.level)).text(name).text(line.text).text("").text("");
  return cdr.put(std::uint32_t{0}).bytes();
}

}  // namespace dynslam
