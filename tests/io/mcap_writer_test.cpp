// SPDX-License-Identifier: MIT
#include "io/mcap_writer.h"

#include <algorithm>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "io/byte_cursor.h"
#include "io/mcap_channels.h"
#include "io/ros_writer.h"
#include "tests/io/read_all.h"

namespace dynslam {
namespace {

using test::Contents;
using test::read_all;
using testing::HasSubstr;

Time at_ms(int ms) { return Time(std::chrono::milliseconds(ms)); }

Scan small_scan(Time stamp) {
  Scan scan{stamp, {}, {{0.05, -0.02, 0.3}, false, 0.21}};
  for (int i = 0; i < 8; ++i) {
    const auto n = static_cast<float>(i);
    scan.beams.push_back({-1.0F + 0.25F * n, 2.0F + n, 0.001F * n});
  }
  return scan;
}

ImuSample small_imu(Time stamp) {
  return {stamp, Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.1, 0.2, 0.9).normalized()))};
}

OdometrySample small_odometry(Time stamp) { return {stamp, {to_seconds(stamp - Time()), -0.25, 0.5}}; }

/// A file in memory as the recorder writes it, a chunk for every scan and two samples.
struct Written {
  std::string bytes;
  std::vector<std::size_t> chunk_ends;
  McapWriter mcap{[this](std::string_view more) { bytes += more; }};
  RosWriter ros{mcap};

  explicit Written(int rounds) {
    mcap.begin("dynslam test", "dynslam", {{"config", "{}"}});
    for (int i = 0; i < rounds; ++i) {
      const Time t = at_ms(100 * i);
      ros.write(t + Duration(1), small_scan(t));
      ros.write(t + Duration(2), small_imu(t));
      ros.write(t + Duration(3), PoseFix{{t, {0.1 * i, 0.0, 0.0}}, {}});
      ros.write(t + Duration(4), small_odometry(t));
      mcap.close_chunk();
      chunk_ends.push_back(bytes.size());
    }
  }
};

TEST(McapWriter, WhatIsWrittenReadsBackExactly) {
  Written file(5);
  file.mcap.finish();
  const Contents all = read_all(file.bytes);
  EXPECT_EQ(all.damage, std::nullopt);
  ASSERT_EQ(all.scans.size(), 5U);
  ASSERT_EQ(all.imu.size(), 5U);
  ASSERT_EQ(all.odometry.size(), 5U) << "of the wheels: what was computed from scans is no sensor";
  EXPECT_EQ(all.counters["mcap.skipped./odom"], 5U);
  EXPECT_EQ(all.counters["stamp.from_log_time"], 0U) << "a robot's clock may begin at zero";
  for (int i = 0; i < 5; ++i) {
    const Scan want = small_scan(at_ms(100 * i));
    const Scan& got = all.scans[static_cast<std::size_t>(i)];
    EXPECT_EQ(got.stamp, want.stamp);
    EXPECT_EQ(got.mount.robot_T_lidar.x, 0.05);
    EXPECT_EQ(got.mount.robot_T_lidar.y, -0.02);
    EXPECT_NEAR(got.mount.robot_T_lidar.yaw, 0.3, 1e-12);
    EXPECT_EQ(got.mount.height_m, 0.21);
    ASSERT_EQ(got.beams.size(), want.beams.size());
    for (std::size_t b = 0; b < want.beams.size(); ++b) {
      EXPECT_EQ(got.beams[b].angle_rad, want.beams[b].angle_rad);
      EXPECT_EQ(got.beams[b].range_m, want.beams[b].range_m);
      EXPECT_FLOAT_EQ(got.beams[b].time_s, want.beams[b].time_s);
    }
    const OdometrySample& wheels = all.odometry[static_cast<std::size_t>(i)];
    EXPECT_EQ(wheels.stamp, want.stamp);
    const Pose2 off = wheels.odom_T_robot.inverse() * small_odometry(want.stamp).odom_T_robot;
    EXPECT_NEAR(off.translation().norm() + std::abs(off.yaw), 0.0, 1e-12);
    EXPECT_EQ(all.imu[static_cast<std::size_t>(i)].stamp, want.stamp);
    EXPECT_EQ(all.imu[static_cast<std::size_t>(i)].world_q_robot.coeffs(),
              small_imu(want.stamp).world_q_robot.coeffs());
  }
}

TEST(McapWriter, ALidarThatHangsUpsideDown) {
  std::string bytes;
  McapWriter mcap([&](std::string_view more) { bytes += more; });
  mcap.begin("test", "dynslam", {});
  Scan scan = small_scan(at_ms(5));
  scan.mount = {{0.1, 0.0, -2.5}, true, 0.4};
  RosWriter(mcap).write(at_ms(6), scan);
  mcap.close_chunk();
  const Contents all = read_all(bytes);
  EXPECT_TRUE(all.scans.at(0).mount.upside_down);
  EXPECT_NEAR(all.scans[0].mount.robot_T_lidar.yaw, -2.5, 1e-12);
  EXPECT_EQ(all.scans[0].mount.height_m, 0.4);
}

TEST(McapWriter, EveryCutLeavesAllChunksBeforeIt) {
  Written file(4);
  file.mcap.finish();
  for (std::size_t cut = kMcapMagic.size(); cut <= file.bytes.size(); ++cut) {
    const Contents all = read_all(file.bytes.substr(0, cut));
    const auto whole = std::upper_bound(file.chunk_ends.begin(), file.chunk_ends.end(), cut);
    const auto chunks = static_cast<std::size_t>(whole - file.chunk_ends.begin());
    ASSERT_GE(all.scans.size(), chunks) << "cut at " << cut;
    ASSERT_LE(all.scans.size(), chunks + 1) << "cut at " << cut;
    for (const Record& record : all.records) ASSERT_TRUE(test::is_clean(record));
  }
}

TEST(McapWriter, NoFlippedBitsBringTheReaderDown) {
  Written file(4);
  file.mcap.finish();
  std::mt19937 random(7);
  std::uniform_int_distribution<std::size_t> place(kMcapMagic.size(), file.bytes.size() - 1);
  int damaged = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string bytes = file.bytes;
    for (int k = 0; k <= i % 3; ++k) bytes[place(random)] ^= static_cast<char>(1U << (random() % 8));
    const Contents all = read_all(bytes);
    for (const Record& record : all.records) ASSERT_TRUE(test::is_clean(record));
    damaged += all.damage ? 1 : 0;
  }
  EXPECT_GT(damaged, 1000) << "most bits lie in chunks, which have a checksum";
}

/// What the end of a file says, read with nothing of the writer but the opcodes.
class Summary {
 public:
  explicit Summary(const std::string& file) : file_(file) {
    ByteCursor footer(bytes(file.size() - kMcapMagic.size() - 20, 20));
    begin_ = footer.number<std::uint64_t>();
    offsets_ = footer.number<std::uint64_t>();
    crc_ = footer.number<std::uint32_t>();
  }
  Bytes bytes(std::uint64_t at, std::uint64_t size) const {
    return Bytes(reinterpret_cast<const std::uint8_t*>(file_.data()), file_.size())
        .subspan(static_cast<std::size_t>(at), static_cast<std::size_t>(size));
  }
  McapOpcode opcode(std::uint64_t at) const { return static_cast<McapOpcode>(file_.at(at)); }
  Bytes content(std::uint64_t at) const {
    return bytes(at + kMcapRecordHead, load<std::uint64_t>(bytes(at + 1, 8).data(), std::endian::little));
  }
  std::vector<Bytes> all(McapOpcode wanted) const {
    std::vector<Bytes> found;
    const std::uint64_t end = file_.size() - kMcapMagic.size();
    for (std::uint64_t at = begin_; at < end; at += kMcapRecordHead + content(at).size()) {
      if (opcode(at) == wanted) found.push_back(content(at));
    }
    return found;
  }
  std::uint32_t crc_of(std::uint64_t from, std::uint64_t to) const {
    const Bytes part = bytes(from, to - from);
    return static_cast<std::uint32_t>(crc32_z(0, part.data(), part.size()));
  }

  const std::string& file_;
  std::uint64_t begin_ = 0, offsets_ = 0;
  std::uint32_t crc_ = 0;
};

TEST(McapWriter, TheIndexPointsAtWhatIsThere) {
  Written file(3);
  file.mcap.finish();
  const Summary summary(file.bytes);
  EXPECT_EQ(summary.all(McapOpcode::kSchema).size(), 6U) << "/scan /imu /odom /tf /tf_static /wheel_odom";
  EXPECT_EQ(summary.all(McapOpcode::kChannel).size(), 6U);
  const auto chunks = summary.all(McapOpcode::kChunkIndex);
  ASSERT_EQ(chunks.size(), 3U);
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    ByteCursor index(chunks[i]);
    EXPECT_EQ(index.number<std::uint64_t>(), 100'000'000U * i + 1) << "first log time";
    EXPECT_EQ(index.number<std::uint64_t>(), 100'000'000U * i + 4) << "last log time";
    const auto at = index.number<std::uint64_t>();
    EXPECT_EQ(summary.opcode(at), McapOpcode::kChunk);
    EXPECT_EQ(index.number<std::uint64_t>(), kMcapRecordHead + summary.content(at).size());
    ByteCursor offsets(index.take(index.number<std::uint32_t>()));
    std::size_t topics = 0;
    for (; offsets.remaining() > 0; ++topics) {
      const auto channel = offsets.number<std::uint16_t>();
      const auto index_at = offsets.number<std::uint64_t>();
      ASSERT_EQ(summary.opcode(index_at), McapOpcode::kMessageIndex);
      EXPECT_EQ(ByteCursor(summary.content(index_at)).number<std::uint16_t>(), channel);
    }
    EXPECT_EQ(topics, i == 0 ? 6U : 5U);
  }
}

TEST(McapWriter, ChecksumsAndCountsAreRight) {
  Written file(3);
  const std::uint64_t data_end = file.bytes.size();
  file.mcap.finish();
  const Summary summary(file.bytes);
  EXPECT_EQ(summary.opcode(data_end), McapOpcode::kDataEnd);
  EXPECT_EQ(ByteCursor(summary.content(data_end)).number<std::uint32_t>(), summary.crc_of(0, data_end));
  EXPECT_EQ(summary.crc_,
            summary.crc_of(summary.begin_, file.bytes.size() - kMcapMagic.size() - sizeof(std::uint32_t)));
  EXPECT_EQ(summary.opcode(summary.offsets_), McapOpcode::kSummaryOffset);
  for (const Bytes offset : summary.all(McapOpcode::kSummaryOffset)) {
    ByteCursor fields(offset);
    const auto opcode = static_cast<McapOpcode>(fields.number<std::uint8_t>());
    EXPECT_EQ(summary.opcode(fields.number<std::uint64_t>()), opcode);
  }
  ByteCursor statistics(summary.all(McapOpcode::kStatistics).at(0));
  EXPECT_EQ(statistics.number<std::uint64_t>(), 3U * 5U + 1U);
  EXPECT_EQ(statistics.number<std::uint16_t>(), 6U);
  EXPECT_EQ(statistics.number<std::uint32_t>(), 6U);
  statistics.number<std::uint32_t>();
  EXPECT_EQ(statistics.number<std::uint32_t>(), 1U) << "metadata";
  EXPECT_EQ(statistics.number<std::uint32_t>(), 3U) << "chunks";
  EXPECT_EQ(statistics.number<std::uint64_t>(), 1U);
  EXPECT_EQ(statistics.number<std::uint64_t>(), 200'000'004U);
  ByteCursor metadata(summary.all(McapOpcode::kMetadataIndex).at(0));
  EXPECT_EQ(summary.opcode(metadata.number<std::uint64_t>()), McapOpcode::kMetadata);
}

TEST(McapWriter, ASinkThatFailsChangesNothing) {
  std::string bytes;
  bool full = false;
  McapWriter mcap([&](std::string_view more) {
    if (full) throw std::runtime_error("full");
    bytes += more;
  });
  RosWriter ros(mcap);
  mcap.begin("test", "dynslam", {});
  ros.write(at_ms(1), small_scan(at_ms(1)));
  mcap.close_chunk();
  ros.write(at_ms(2), small_imu(at_ms(2)));
  full = true;
  EXPECT_THROW(mcap.close_chunk(), std::runtime_error);
  const std::uint64_t size = mcap.bytes();
  EXPECT_GT(mcap.waiting(), 0U);
  full = false;
  std::string given_up = bytes;
  mcap.close_chunk();
  EXPECT_GT(mcap.bytes(), size);
  EXPECT_EQ(read_all(bytes).imu.size(), 1U) << "once there is room again";
  EXPECT_TRUE(read_all(given_up).imu.empty());
}

TEST(McapWriter, WhatIsDroppedIsNotInTheIndex) {
  Written file(2);
  file.ros.write(at_ms(1000), DriveCommand{});
  file.mcap.drop_chunk();
  file.mcap.finish();
  EXPECT_EQ(read_all(file.bytes).damage, std::nullopt);
  EXPECT_THAT(file.bytes, testing::Not(HasSubstr("/cmd_vel")));
  EXPECT_EQ(Summary(file.bytes).all(McapOpcode::kChunkIndex).size(), 2U);
}

TEST(McapWriter, AFileWithoutMessagesIsAFile) {
  std::string bytes;
  McapWriter mcap([&](std::string_view more) { bytes += more; });
  mcap.begin("test", "dynslam", {{"config", "{}"}});
  mcap.close_chunk();
  mcap.finish();
  const Contents all = read_all(bytes);
  EXPECT_TRUE(all.records.empty());
  EXPECT_EQ(all.damage, std::nullopt);
}

}  // namespace
}  // namespace dynslam
