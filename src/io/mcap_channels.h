// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>

#include "io/mcap_stream.h"

namespace dynslam {

/// What the messages of a channel are to us.
enum class McapKind : std::uint8_t { kOther, kScan, kImu, kOdometry, kTransforms };

/// Keys in the metadata of a channel that a robot of ours recorded.
/// The topic that this one was computed from: it is no sensor of its own, and kOther.
inline constexpr std::string_view kDerivedFromKey = "dynslam.derived_from";
/// Written by RosWriter: a stamp of zero is one, and scans may have readings between the beams, see ScanFan.
inline constexpr std::string_view kOursKey = "dynslam.layout";

struct McapChannel {
  McapKind kind = McapKind::kOther;
  std::string topic;  ///< cut to 256 characters
  bool ours = false;  ///< see kOursKey
};

struct McapMessage {
  std::uint16_t channel_id = 0;
  std::uint64_t log_time_ns = 0;
  Bytes data;
};

/// Nothing if the record is cut off.
std::optional<McapMessage> parse_mcap_message(Bytes content);

/// Which channel carries what, as the schema and channel records tell it. Of a schema only the name counts,
/// as ROS 2 or ROS 1 write it; of a channel the topic, and that its messages are in CDR. Both ids have 16
/// bits, which bounds memory.
class McapChannels {
 public:
  /// Learns from a schema or channel record; others do nothing. False if the record is cut off.
  bool take(const McapRecord& record);

  /// Null for a channel never heard of. Valid until the next take().
  const McapChannel* find(std::uint16_t id) const;

 private:
  bool take_schema(Bytes content);
  bool take_channel(Bytes content);

  std::unordered_map<std::uint16_t, McapKind> schemas_;
  std::unordered_map<std::uint16_t, McapChannel> channels_;
};

}  // namespace dynslam
