// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/drive_command.h"
#include "base/odometry.h"
#include "base/pose_estimate.h"
#include "io/mcap_writer.h"
#include "io/ros_encoding.h"

namespace dynslam {

/// A pose and what it is made of. The frame `odom` is continuous and drifts; `map` lies on it as the closed
/// loops have it, and may jump (REP-105).
struct PoseFix {
  PoseEstimate pose;
  Pose2 map_T_odom;
};

/// Puts what a robot senses, decides and is told into an MCAP file, each kind on its topic. `now` is the time
/// at which it was heard of, the file's log time; stamps are those of the values. One thread at a time.
class RosWriter {
 public:
  /// `mcap` must outlive it and have no other writer.
  explicit RosWriter(McapWriter& mcap) : mcap_(mcap) {}

  void write(Time now, const Scan& scan);  ///< also where the lidar sits, when that is news
  void write(Time now, const ImuSample& sample);
  void write(Time now, const OdometrySample& wheels);
  void write(Time now, const PoseFix& fix);
  void write(Time now, const DriveCommand& command);
  void write(Time now, const JpegFrame& frame);
  void write_applied(Time now, const Twist& twist);
  void write_battery(Time now, const BatteryState& battery);
  void write_route(Time now, std::span<const Vector2> route_map);
  void write_map(Time now, Time stamp, const TrinaryMap& map);
  void write_diagnostics(Time now, std::span<const DiagnosticStatus> statuses);
  void write_log(Time now, const LogLine& line, std::string_view name);

 private:
  enum Topic {
    kScan,
    kImu,
    kOdometry,
    kBattery,
    kCommand,
    kApplied,
    kTransforms,
    kStatic,
    kMap,
    kPicture,
    kDiagnostics,
    kLog,
    kWheels,
    kRoute,
    kTopics
  };
  static McapTopic describe(Topic topic);
  void put(Topic topic, Time now, Time stamp, std::string_view message);
  void tell_mount(Time now, const Scan& scan);
  McapWriter& mcap_;
  std::array<std::uint16_t, kTopics> channels_{};  ///< 0: not yet there
  std::optional<LidarMount> told_mount_;
  std::optional<OdometrySample> last_place_, last_wheels_;
};

}  // namespace dynslam
