// SPDX-License-Identifier: MIT
#include "io/mcap_recording.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "io/ros_messages.h"
#include "io/scan_fan.h"

namespace dynslam {
namespace {

constexpr std::uint64_t kLookAheadNs = 5'000'000'000;
constexpr int kLookAheadMessages = 2000;
constexpr double kLevel = 0.94;  // cos 20 degrees

TfTree transforms_near_start(ByteSource& source) {
  TfTree tree;
  Counters ignored;
  McapStream stream(source, ignored);
  McapChannels channels;
  std::optional<std::uint64_t> first_ns;
  for (int messages = 0; messages < kLookAheadMessages;) {
    const std::optional<McapRecord> record = stream.next();
    if (!record) break;
    channels.take(*record);
    if (record->opcode != McapOpcode::kMessage) continue;
    ++messages;
    const std::optional<McapMessage> message = parse_mcap_message(record->content);
    if (!message) continue;
    if (!first_ns) first_ns = message->log_time_ns;
    if (message->log_time_ns > *first_ns && message->log_time_ns - *first_ns > kLookAheadNs) break;
    const McapChannel* channel = channels.find(message->channel_id);
    if (channel != nullptr && channel->kind == McapKind::kTransforms) decode_transforms(message->data, tree);
  }
  return tree;
}

std::string seconds_text(std::uint64_t nanoseconds) {
  const std::uint64_t tenths = nanoseconds / 100'000'000;
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " s";
}

}  // namespace

McapRecording::McapRecording(std::unique_ptr<ByteSource> source, const RecordingConfig& config)
    : source_(std::move(source)),
      config_mount_(config.lidar_mount),
      tree_(transforms_near_start(*source_)),
      skipped_(counters_, "mcap.skipped"),
      stream_(*source_, counters_) {}

double McapRecording::progress() const {
  if (ended_ || source_->size() == 0) return 1.0;
  return std::min(1.0, static_cast<double>(source_->position()) / static_cast<double>(source_->size()));
}

std::optional<Record> McapRecording::next() {
  while (!ended_) {
    const std::optional<McapRecord> record = stream_.next();
    if (!record) {
      finish();
    } else if (record->opcode == McapOpcode::kMessage) {
      if (std::optional<Record> result = take_message(record->content)) return result;
    } else if (!channels_.take(*record)) {
      counters_.add("mcap.bad_records");
    }
  }
  return std::nullopt;
}

void McapRecording::finish() {
  ended_ = true;
  if (stream_.fault().empty()) return;
  const std::uint64_t first = first_log_time_ns_.value_or(0);
  const std::uint64_t span = last_log_time_ns_ > first ? last_log_time_ns_ - first : 0;
  damage_ = source_->name() + ": " + stream_.fault() + "; " + seconds_text(span) + " with " +
            std::to_string(scans_) + " scans could be read";
}

std::optional<Record> McapRecording::take_message(Bytes content) {
  const std::optional<McapMessage> message = parse_mcap_message(content);
  if (!message) {
    counters_.add("mcap.bad_records");
    return std::nullopt;
  }
  if (!first_log_time_ns_) first_log_time_ns_ = message->log_time_ns;
  last_log_time_ns_ = std::max(last_log_time_ns_, message->log_time_ns);
  const McapChannel* channel = channels_.find(message->channel_id);
  if (channel == nullptr) {
    counters_.add("mcap.unknown_channel");
    return std::nullopt;
  }
  std::string& used_topic = used_topics_[static_cast<std::size_t>(channel->kind)];
  if (channel->kind == McapKind::kOther || (!used_topic.empty() && used_topic != channel->topic)) {
    skipped_.add(channel->topic);
    return std::nullopt;
  }
  std::optional<Record> record = decode(*channel, *message);
  if (record) used_topic = channel->topic;
  return record;
}

std::optional<Record> McapRecording::decode(const McapChannel& channel, const McapMessage& message) {
  switch (channel.kind) {
    case McapKind::kScan:
      return decode_scan(message, channel.ours);
    case McapKind::kImu:
      return decode_imu_sample(message, channel.ours);
    case McapKind::kOdometry:
      return decode_odometry_sample(message, channel.ours);
    case McapKind::kTransforms:
      if (!decode_transforms(message.data, tree_)) counters_.add("tf.bad");
      return std::nullopt;
    case McapKind::kOther:
      break;
  }
  return std::nullopt;
}

std::optional<Record> McapRecording::decode_scan(const McapMessage& message, bool ours) {
  std::optional<RosMessage<Scan>> scan = decode_laser_scan(message.data);
  if (!scan) {
    counters_.add("scan.bad");
    return std::nullopt;
  }
  const std::optional<Time> stamp = stamp_of(scan->header.stamp, message, ours);
  if (!stamp) return std::nullopt;
  if (ours) drop_gaps(scan->value);
  scan->value.stamp = *stamp;
  scan->value.mount = mount_of(scan->header.frame_id);
  ++scans_;
  return std::move(scan->value);
}

std::optional<Record> McapRecording::decode_imu_sample(const McapMessage& message, bool ours) {
  ImuFault fault = ImuFault::kNone;
  const RosMessage<Eigen::Quaterniond> imu = decode_imu(message.data, fault);
  if (fault != ImuFault::kNone) {
    counters_.add(name_of(fault));
    return std::nullopt;
  }
  const std::optional<Time> stamp = stamp_of(imu.header.stamp, message, ours);
  if (!stamp) return std::nullopt;
  Eigen::Quaterniond world_q_robot = imu.value;
  const auto robot_T_imu = tree_.robot_T(imu.header.frame_id);
  if (robot_T_imu && robot_T_imu->linear() != Eigen::Matrix3d::Identity()) {
    world_q_robot = (imu.value * Eigen::Quaterniond(robot_T_imu->linear()).inverse()).normalized();
  }
  return ImuSample{*stamp, world_q_robot};
}

std::optional<Record> McapRecording::decode_odometry_sample(const McapMessage& message, bool ours) {
  const std::optional<RosMessage<Pose2>> odometry = decode_odometry(message.data);
  if (!odometry) {
    counters_.add("odometry.bad");
    return std::nullopt;
  }
  const std::optional<Time> stamp = stamp_of(odometry->header.stamp, message, ours);
  if (!stamp) return std::nullopt;
  return OdometrySample{*stamp, odometry->value};
}

/// The sensor's own stamp, or, where the driver left it zero, when the message was recorded.
std::optional<Time> McapRecording::stamp_of(Time stamp, const McapMessage& message, bool ours) {
  if (ours || stamp != Time{}) return stamp;
  if (message.log_time_ns > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()) ||
      !is_representable_s(static_cast<double>(message.log_time_ns) * 1e-9)) {
    counters_.add("stamp.bad");
    return std::nullopt;
  }
  counters_.add("stamp.from_log_time");
  return Time(Duration(static_cast<std::int64_t>(message.log_time_ns)));
}

LidarMount McapRecording::mount_of(std::string_view frame) {
  const std::optional<Eigen::Isometry3d> robot_T_lidar = tree_.robot_T(frame);
  if (!robot_T_lidar) return config_mount_;
  const Eigen::Matrix3d axes = robot_T_lidar->linear();
  if (std::abs(axes(2, 2)) < kLevel) counters_.add("tf.tilted_lidar");
  const Eigen::Vector3d at = robot_T_lidar->translation();
  // Where the lidar's x axis points; for one that hangs upside down this is the yaw before the roll by pi.
  return {{at.x(), at.y(), std::atan2(axes(1, 0), axes(0, 0))}, axes(2, 2) < 0.0, height_of(frame)};
}

/// What a small robot's lidar can have; else what was configured.
double McapRecording::height_of(std::string_view frame) const {
  constexpr double kLow_m = 0.02, kHigh_m = 3.0;
  const double height_m = tree_.height_m(frame).value_or(0.0);
  return height_m >= kLow_m && height_m <= kHigh_m ? height_m : config_mount_.height_m;
}

}  // namespace dynslam
