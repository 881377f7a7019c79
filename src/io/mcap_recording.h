// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "io/byte_source.h"
#include "io/mcap_channels.h"
#include "io/mcap_stream.h"
#include "io/recording.h"
#include "io/skip_counts.h"
#include "io/tf_tree.h"

namespace dynslam {

/// An MCAP file with messages of ROS 2: LaserScan, Imu (its orientation), Odometry, and /tf_static for where
/// the sensors sit. Of several topics of one type, the first one that has a usable message is used. All
/// others count as `mcap.skipped.TOPIC`.
///
/// Recorders write /tf_static whenever it arrives, which may be after the first scans; so the first seconds
/// are looked through for it beforehand. What it says of the lidar wins over the configured mount.
class McapRecording final : public Recording {
 public:
  /// The source begins with the magic bytes.
  McapRecording(std::unique_ptr<ByteSource> source, const RecordingConfig& config);

  std::optional<Record> next() override;
  double progress() const override;
  const std::optional<std::string>& damage() const override { return damage_; }
  const Counters& counters() const override { return counters_; }

 private:
  std::optional<Record> take_message(Bytes content);
  std::optional<Record> decode(const McapChannel& channel, const McapMessage& message);
  std::optional<Record> decode_scan(const McapMessage& message, bool ours);
  std::optional<Record> decode_imu_sample(const McapMessage& message, bool ours);
  std::optional<Record> decode_odometry_sample(const McapMessage& message, bool ours);
  std::optional<Time> stamp_of(Time stamp, const McapMessage& message, bool ours);
  LidarMount mount_of(std::string_view frame);
  double height_of(std::string_view frame) const;
  void finish();

  std::unique_ptr<ByteSource> source_;
  LidarMount config_mount_;
  TfTree tree_;
  Counters counters_;
  SkipCounts skipped_;
  McapStream stream_;
  McapChannels channels_;
  std::array<std::string, 5> used_topics_;  ///< by McapKind; empty as long as none was usable
  std::optional<std::uint64_t> first_log_time_ns_;
  std::uint64_t last_log_time_ns_ = 0;
  std::uint64_t scans_ = 0;
  bool ended_ = false;
  std::optional<std::string> damage_;
};

}  // namespace dynslam
