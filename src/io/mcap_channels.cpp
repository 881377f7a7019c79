// SPDX-License-Identifier: MIT
#include "io/mcap_channels.h"

namespace dynslam {
namespace {

constexpr std::size_t kMaxTopicLength = 256;

McapKind kind_of(std::string_view schema) {
  if (schema == "sensor_msgs/msg/LaserScan" || schema == "sensor_msgs/LaserScan") return McapKind::kScan;
  if (schema == "sensor_msgs/msg/Imu" || schema == "sensor_msgs/Imu") return McapKind::kImu;
  if (schema == "nav_msgs/msg/Odometry" || schema == "nav_msgs/Odometry") return McapKind::kOdometry;
  if (schema == "tf2_msgs/msg/TFMessage" || schema == "tf2_msgs/TFMessage") return McapKind::kTransforms;
  return McapKind::kOther;
}

/// Whether a map of texts has the key.
bool has_key(std::string_view map, std::string_view key) {
  ByteCursor cursor({reinterpret_cast<const std::uint8_t*>(map.data()), map.size()});
  while (cursor.ok() && cursor.remaining() > 0) {
    if (cursor.text() == key) return true;
    cursor.text();
  }
  return false;
}

}  // namespace

// channel (16 bits), sequence (32), log time, publish time (64 each), data
std::optional<McapMessage> parse_mcap_message(Bytes content) {
  ByteCursor cursor(content);
  McapMessage message;
  message.channel_id = cursor.number<std::uint16_t>();
  cursor.number<std::uint32_t>();
  message.log_time_ns = cursor.number<std::uint64_t>();
  cursor.number<std::uint64_t>();
  message.data = cursor.take(cursor.remaining());
  if (!cursor.ok()) return std::nullopt;
  return message;
}

bool McapChannels::take(const McapRecord& record) {
  if (record.opcode == McapOpcode::kSchema) return take_schema(record.content);
  if (record.opcode == McapOpcode::kChannel) return take_channel(record.content);
  return true;
}

const McapChannel* McapChannels::find(std::uint16_t id) const {
  const auto channel = channels_.find(id);
  return channel == channels_.end() ? nullptr : &channel->second;
}

// id (16 bits), name, encoding, definition
bool McapChannels::take_schema(Bytes content) {
  ByteCursor cursor(content);
  const auto id = cursor.number<std::uint16_t>();
  const std::string_view name = cursor.text();
  if (!cursor.ok()) return false;
  schemas_[id] = kind_of(name);
  return true;
}

// id, schema (16 bits each), topic, encoding of the messages, metadata
bool McapChannels::take_channel(Bytes content) {
  ByteCursor cursor(content);
  const auto id = cursor.number<std::uint16_t>();
  const auto schema = schemas_.find(cursor.number<std::uint16_t>());
  const std::string_view topic = cursor.text();
  const std::string_view encoding = cursor.text();
  const std::string_view metadata = cursor.text();
  if (!cursor.ok()) return false;
  const bool is_known = schema != schemas_.end() && encoding == "cdr";
  McapKind kind = is_known ? schema->second : McapKind::kOther;
  // /tf has the same type, but moves.
  if (kind == McapKind::kTransforms && topic != "/tf_static" && topic != "tf_static") kind = McapKind::kOther;
  if (has_key(metadata, kDerivedFromKey)) kind = McapKind::kOther;
  channels_[id] = {kind, std::string(topic.substr(0, kMaxTopicLength)), has_key(metadata, kOursKey)};
  return true;
}

}  // namespace dynslam
