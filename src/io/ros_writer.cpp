// SPDX-License-Identifier: MIT
#include "io/ros_writer.h"

#include <algorithm>
#include <utility>

#include "base/angles.h"
#include "io/mcap_channels.h"
#include "io/ros_schema.h"

namespace dynslam {
namespace {

constexpr std::string_view kLaser = "laser", kImuLink = "imu_link", kBase = "base_link";

std::uint64_t nanoseconds(Time t) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(0, t.time_since_epoch().count()));
}

/// Zero across a longer pause.
Twist speed_between(const std::optional<OdometrySample>& last, const OdometrySample& now) {
  constexpr double kLongest_s = 0.5;
  const double passed_s = last ? to_seconds(now.stamp - last->stamp) : 0.0;
  if (passed_s <= 0.0 || passed_s > kLongest_s) return {};
  const Pose2 step = last->odom_T_robot.inverse() * now.odom_T_robot;
  return {step.x / passed_s, wrap_angle(step.yaw) / passed_s};
}

bool same(const LidarMount& a, const LidarMount& b) {
  return a.robot_T_lidar == b.robot_T_lidar && a.upside_down == b.upside_down && a.height_m == b.height_m;
}

}  // namespace

McapTopic RosWriter::describe(Topic topic) {
  struct Row {
    std::string_view topic, package, type;
  };
  constexpr std::array<Row, kTopics> kRows = {{{"/scan", "sensor_msgs", "LaserScan"},
                                               {"/imu", "sensor_msgs", "Imu"},
                                               {"/odom", "nav_msgs", "Odometry"},
                                               {"/battery", "sensor_msgs", "BatteryState"},
                                               {"/cmd_vel", "geometry_msgs", "TwistStamped"},
                                               {"/cmd_vel_applied", "geometry_msgs", "TwistStamped"},
                                               {"/tf", "tf2_msgs", "TFMessage"},
                                               {"/tf_static", "tf2_msgs", "TFMessage"},
                                               {"/map", "nav_msgs", "OccupancyGrid"},
                                               {"/camera/compressed", "sensor_msgs", "CompressedImage"},
                                               {"/diagnostics", "diagnostic_msgs", "DiagnosticArray"},
                                               {"/rosout", "rcl_interfaces", "Log"},
                                               {"/wheel_odom", "nav_msgs", "Odometry"},
                                               {"/plan", "nav_msgs", "Path"}}};
  const Row& row = kRows[topic];
  const std::string package(row.package), type(row.type);
  McapTopic out{std::string(row.topic),
                package + "/msg/" + type,
                ros_schema(package + '/' + type),
                {{std::string(kOursKey), "1"}}};
  // Taken for the wheels' word it would make a scan agree with itself.
  if (topic == kOdometry) out.metadata.emplace(kDerivedFromKey, "/scan");
  return out;
}

void RosWriter::put(Topic topic, Time now, Time stamp, std::string_view message) {
  if (channels_[topic] == 0) channels_[topic] = mcap_.add_channel(describe(topic));
  mcap_.add_message(channels_[topic], nanoseconds(now), nanoseconds(stamp), message);
}

void RosWriter::write(Time now, const Scan& scan) {
  if (!told_mount_ || !same(*told_mount_, scan.mount)) tell_mount(now, scan);
  put(kScan, now, scan.stamp, encode_laser_scan(scan, kLaser));
}

/// The robot's frame lies on the floor: that is where heights are measured from.
void RosWriter::tell_mount(Time now, const Scan& scan) {
  told_mount_ = scan.mount;
  const RosTransform all[] = {
      {scan.stamp, kBase, "base_footprint", {}},
      {scan.stamp, kBase, kImuLink, {}},
      {scan.stamp, kBase, kLaser, scan.mount.robot_T_lidar, scan.mount.height_m, scan.mount.upside_down}};
  put(kStatic, now, scan.stamp, encode_transforms(all));
}

void RosWriter::write(Time now, const ImuSample& sample) {
  put(kImu, now, sample.stamp, encode_imu(sample, kImuLink));
}

void RosWriter::write(Time now, const PoseFix& fix) {
  const Time stamp = fix.pose.stamp;
  const Pose2 odom_T_robot = fix.map_T_odom.inverse() * fix.pose.map_T_robot;
  const RosTransform all[] = {{stamp, "map", "odom", fix.map_T_odom}, {stamp, "odom", kBase, odom_T_robot}};
  put(kTransforms, now, stamp, encode_transforms(all));
  const Twist speed = speed_between(last_place_, {stamp, odom_T_robot});
  last_place_ = {stamp, odom_T_robot};
  put(kOdometry, now, stamp, encode_odometry("odom", stamp, odom_T_robot, fix.pose.covariance, speed));
}

/// How sure wheels are nobody knows: they slip. Their frame is their own, and no part of the tree.
void RosWriter::write(Time now, const OdometrySample& wheels) {
  const Twist speed = speed_between(last_wheels_, wheels);
  last_wheels_ = wheels;
  put(kWheels, now, wheels.stamp,
      encode_odometry("wheels", wheels.stamp, wheels.odom_T_robot, Eigen::Matrix3d::Zero(), speed));
}

void RosWriter::write(Time now, const DriveCommand& command) {
  put(kCommand, now, command.heard, encode_twist(command.heard, command.twist));
}

void RosWriter::write(Time now, const JpegFrame& frame) {
  put(kPicture, now, frame.stamp, encode_image(frame));
}

void RosWriter::write_applied(Time now, const Twist& twist) {
  put(kApplied, now, now, encode_twist(now, twist));
}

void RosWriter::write_route(Time now, std::span<const Vector2> route_map) {
  put(kRoute, now, now, encode_path(now, route_map));
}

void RosWriter::write_battery(Time now, const BatteryState& battery) {
  put(kBattery, now, now, encode_battery(now, battery));
}

void RosWriter::write_map(Time now, Time stamp, const TrinaryMap& map) {
  put(kMap, now, stamp, encode_grid(stamp, map));
}

void RosWriter::write_diagnostics(Time now, std::span<const DiagnosticStatus> statuses) {
  put(kDiagnostics, now, now, encode_diagnostics(now, statuses));
}

void RosWriter::write_log(Time now, const LogLine& line, std::string_view name) {
  put(kLog, now, line.time, encode_log(line, name));
}

}  // namespace dynslam
