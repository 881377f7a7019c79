// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "io/chunk_unpacker.h"
#include "io/mcap_stream.h"
#include "tests/io/mcap_builder.h"
#include "tests/io/read_all.h"

namespace dynslam {
namespace {

using test::Contents;
using test::imu;
using test::laser_scan;
using test::LaserScanFields;
using test::le;
using test::le_text;
using test::McapBuilder;
using test::odometry;
using test::Quaternion;
using test::read_all;
using test::transforms;
using testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kStart = 1000 * kMs;
const Quaternion kUpsideDown{1.0, 0.0, 0.0, 0.0};
const Quaternion kQuarterLeft{0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)};

constexpr std::size_t kDataEndSize = 9 + 4;

std::string scan_at(std::int64_t stamp_ns, const std::string& frame = "laser") {
  LaserScanFields fields;
  fields.stamp_ns = stamp_ns;
  fields.frame = frame;
  return laser_scan(fields);
}

/// Ten times or so a scan, two IMU samples and odometry, 10 ms apart.
McapBuilder small_file(const McapBuilder::Options& options, int rounds = 10) {
  McapBuilder file(options);
  const auto scans = file.add_channel("/scan", "sensor_msgs/msg/LaserScan");
  const auto imus = file.add_channel("/imu", "sensor_msgs/msg/Imu");
  const auto wheels = file.add_channel("/odom", "nav_msgs/msg/Odometry");
  for (int i = 0; i < rounds; ++i) {
    const std::int64_t t = kStart + i * 10 * kMs;
    file.add_message(scans, static_cast<std::uint64_t>(t), scan_at(t));
    file.add_message(imus, static_cast<std::uint64_t>(t + kMs), imu(t + kMs, {}));
    file.add_message(imus, static_cast<std::uint64_t>(t + 2 * kMs), imu(t + 2 * kMs, kQuarterLeft));
    file.add_message(wheels, static_cast<std::uint64_t>(t + 3 * kMs), odometry(t + 3 * kMs, i, 0.0, {}));
  }
  return file;
}

std::vector<McapBuilder::Options> all_layouts() {
  std::vector<McapBuilder::Options> layouts;
  for (const bool rich : {false, true}) {
    layouts.push_back({std::nullopt, 4, rich, rich});
    for (const char* compression : {"", "zstd", "lz4"}) layouts.push_back({compression, 4, rich, rich});
  }
  return layouts;
}

/// One channel of each type that is read.
struct Channels {
  explicit Channels(McapBuilder& file)
      : scan(file.add_channel("/scan", "sensor_msgs/msg/LaserScan")),
        imu(file.add_channel("/imu", "sensor_msgs/msg/Imu")),
        tf(file.add_channel("/tf_static", "tf2_msgs/msg/TFMessage")) {}
  std::uint16_t scan, imu, tf;
};

TEST(McapRecordingTest, EveryLayoutSaysTheSameInFileOrder) {
  for (const auto& layout : all_layouts()) {
    const Contents all = read_all(small_file(layout).finish());
    EXPECT_EQ(all.scans.size(), 10U);
    EXPECT_EQ(all.imu.size(), 20U);
    EXPECT_EQ(all.odometry.size(), 10U);
    EXPECT_EQ(all.damage, std::nullopt);
    EXPECT_TRUE(all.counters.empty());
    std::string order;
    for (const Record& record : all.records) order += std::to_string(record.index());
    EXPECT_EQ(order.substr(0, 8), "01120112");
    EXPECT_EQ(all.scans.at(3).stamp, Time(Duration(kStart + 30 * kMs)));
    EXPECT_EQ(all.scans[3].beams.size(), 3U);
    EXPECT_NEAR(yaw_of(all.imu.at(1).world_q_robot), kPi / 2.0, 1e-9);
    EXPECT_EQ(all.odometry.at(4).odom_T_robot.x, 4.0);
  }
}

TEST(McapRecordingTest, Ros1NamesAreReadOtherEncodingsAreNot) {
  McapBuilder file;
  const auto ros1 = file.add_channel("/scan", "sensor_msgs/LaserScan");
  const auto json = file.add_channel("/scan_json", "sensor_msgs/msg/LaserScan", "json");
  file.add_message(json, 1, "{}");
  file.add_message(ros1, 2, scan_at(kStart));
  const Contents all = read_all(file.finish());
  EXPECT_EQ(all.scans.size(), 1U);
  EXPECT_EQ(all.counters["mcap.skipped./scan_json"], 1U);
}

TEST(McapRecordingTest, TheFirstTopicWithAUsableMessageIsUsed) {
  McapBuilder file;
  const auto raw = file.add_channel("/imu/data_raw", "sensor_msgs/msg/Imu");
  const auto fused = file.add_channel("/imu/data", "sensor_msgs/msg/Imu");
  const auto second = file.add_channel("/imu/second", "sensor_msgs/msg/Imu");
  for (int i = 0; i < 3; ++i) {
    file.add_message(raw, 1, imu(kStart, {0, 0, 0, 0}, -1.0));
    file.add_message(fused, 1, imu(kStart, {}));
    file.add_message(second, 1, imu(kStart, {}));
  }
  const Contents all = read_all(file.finish());
  EXPECT_EQ(all.imu.size(), 3U);
  EXPECT_EQ(all.counters["imu.no_orientation"], 1U);
  EXPECT_EQ(all.counters["mcap.skipped./imu/data_raw"], 2U);
  EXPECT_EQ(all.counters["mcap.skipped./imu/second"], 3U);
}

TEST(McapRecordingTest, SkippedTopicsAreBoundedAndPrintable) {
  McapBuilder file;
  for (int i = 0; i < 100; ++i) {
    file.add_message(file.add_channel("/t" + std::to_string(i), "std_msgs/msg/String"), 1, "x");
  }
  const Contents all = read_all(file.finish());
  EXPECT_EQ(all.counters["mcap.skipped./t0"], 1U);
  EXPECT_EQ(all.counters["mcap.skipped.other"], 68U);
  McapBuilder odd;
  odd.add_message(odd.add_channel("/\xFF\n" + std::string(500, 'x'), "std_msgs/msg/String"), 1, "x");
  const Contents cleaned = read_all(odd.finish());
  EXPECT_EQ(cleaned.counters.begin()->first, "mcap.skipped./??" + std::string(77, 'x'));
}

TEST(McapRecordingTest, BadMessagesAreCounted) {
  McapBuilder file;
  const Channels on(file);
  const auto wheels = file.add_channel("/odom", "nav_msgs/msg/Odometry");
  file.add_message(on.scan, 1, "short");
  file.add_message(on.imu, 1, "short");
  file.add_message(on.imu, 1, imu(kStart, {0, 0, 0, 2}));
  file.add_message(wheels, 1, "short");
  file.add_message(on.tf, 1, "short");
  file.add_message(999, 1, "to nobody");
  file.add_records(McapBuilder::record(0x05, "short") + McapBuilder::record(0x04, "x") +
                   McapBuilder::record(0x03, "x"));
  file.add_message(on.scan, 1, scan_at(kStart));
  const Contents all = read_all(file.finish());
  EXPECT_EQ(all.records.size(), 1U);
  EXPECT_EQ(all.counters["scan.bad"], 1U);
  EXPECT_EQ(all.counters["imu.bad"], 1U);
  EXPECT_EQ(all.counters["imu.bad_quaternion"], 1U);
  EXPECT_EQ(all.counters["odometry.bad"], 1U);
  EXPECT_EQ(all.counters["tf.bad"], 1U);
  EXPECT_EQ(all.counters["mcap.unknown_channel"], 1U);
  EXPECT_EQ(all.counters["mcap.bad_records"], 3U);
  EXPECT_EQ(all.damage, std::nullopt);
}

TEST(McapRecordingTest, StampFromTheLogTimeWhereTheDriverLeftItZero) {
  McapBuilder file;
  const Channels on(file);
  const auto wheels = file.add_channel("/odom", "nav_msgs/msg/Odometry");
  file.add_message(on.scan, 5000, scan_at(0));
  file.add_message(on.imu, 6000, imu(0, {}));
  file.add_message(wheels, 7000, odometry(0, 1, 2, {}));
  file.add_message(on.scan, ~std::uint64_t{0}, scan_at(0));
  file.add_message(on.imu, ~std::uint64_t{0}, imu(0, {}));
  file.add_message(wheels, std::uint64_t{9'100'000'000'000'000'000}, odometry(0, 1, 2, {}));
  const Contents all = read_all(file.finish());
  EXPECT_EQ(all.scans.at(0).stamp, Time(Duration(5000)));
  EXPECT_EQ(all.imu.at(0).stamp, Time(Duration(6000)));
  EXPECT_EQ(all.odometry.at(0).stamp, Time(Duration(7000)));
  EXPECT_EQ(all.counters["stamp.from_log_time"], 3U);
  EXPECT_EQ(all.counters["stamp.bad"], 3U);
}

TEST(McapRecordingTest, TimeMayRunBackwards) {
  McapBuilder file;
  const Channels on(file);
  file.add_message(on.scan, 2, scan_at(2 * kStart));
  file.add_message(on.scan, 1, scan_at(kStart));
  const Contents all = read_all(file.finish());
  EXPECT_GT(all.scans.at(0).stamp, all.scans.at(1).stamp);
}

TEST(McapMountTest, FromTfStaticEvenIfItComesAfterTheFirstScan) {
  RecordingConfig config;
  config.lidar_mount = {{9.0, 9.0, 9.0}, true};
  McapBuilder file;
  const Channels on(file);
  file.add_message(on.scan, 1, scan_at(kStart));
  file.add_message(on.tf, 2,
                   transforms({{"base_link", "mast", 0.1, 0.0, 0.3, kQuarterLeft}, {"mast", "laser", 0.2}}));
  file.add_message(on.scan, 3, scan_at(kStart, "elsewhere"));
  const Contents all = read_all(file.finish(), config);
  const LidarMount mount = all.scans.at(0).mount;
  EXPECT_NEAR(mount.robot_T_lidar.x, 0.1, 1e-9);
  EXPECT_NEAR(mount.robot_T_lidar.y, 0.2, 1e-9);
  EXPECT_NEAR(mount.robot_T_lidar.yaw, kPi / 2.0, 1e-9);
  EXPECT_FALSE(mount.upside_down);
  EXPECT_EQ(all.scans.at(1).mount.robot_T_lidar, config.lidar_mount.robot_T_lidar);
}

TEST(McapMountTest, UpsideDownAndTilted) {
  McapBuilder file;
  const Channels on(file);
  const Quaternion tilted{0.0, std::sin(0.3), 0.0, std::cos(0.3)};
  file.add_message(
      on.tf, 1,
      transforms({{"base_link", "laser", 0, 0, 0, kUpsideDown}, {"base_link", "t", 0, 0, 0, tilted}}));
  file.add_message(on.scan, 1, scan_at(kStart));
  file.add_message(on.scan, 1, scan_at(kStart, "t"));
  const Contents all = read_all(file.finish());
  EXPECT_TRUE(all.scans.at(0).mount.upside_down);
  EXPECT_NEAR(all.scans[0].mount.robot_T_lidar.yaw, 0.0, 1e-9);
  EXPECT_EQ(all.counters["tf.tilted_lidar"], 1U);
}

TEST(McapMountTest, MovingTransformsAreNoMount) {
  McapBuilder file;
  const Channels on(file);
  file.add_message(file.add_channel("/tf", "tf2_msgs/msg/TFMessage"), 1,
                   transforms({{"base_link", "laser", 1.0}}));
  file.add_message(on.scan, 1, scan_at(kStart));
  const Contents all = read_all(file.finish());
  EXPECT_EQ(all.scans.at(0).mount.robot_T_lidar, Pose2{});
  EXPECT_EQ(all.counters["mcap.skipped./tf"], 1U);
}

TEST(McapMountTest, TheLookAheadEndsAfterFiveSeconds) {
  McapBuilder file;
  const Channels on(file);
  file.add_message(on.scan, 0, scan_at(kStart));
  file.add_message(on.scan, 6000 * kMs, scan_at(kStart));
  file.add_message(on.tf, 6001 * kMs, transforms({{"base_link", "laser", 1.0}}));
  file.add_message(on.scan, 6002 * kMs, scan_at(kStart));
  const Contents all = read_all(file.finish());
  EXPECT_EQ(all.scans.at(1).mount.robot_T_lidar.x, 0.0);
  EXPECT_EQ(all.scans.at(2).mount.robot_T_lidar.x, 1.0);
}

TEST(McapMountTest, ImuTurnedOnTheRobot) {
  McapBuilder file;
  const Channels on(file);
  file.add_message(on.tf, 1, transforms({{"base_link", "imu", 0, 0, 0, kQuarterLeft}}));
  file.add_message(on.imu, 1, imu(kStart, kQuarterLeft));
  const Contents all = read_all(file.finish());
  EXPECT_NEAR(yaw_of(all.imu.at(0).world_q_robot), 0.0, 1e-9);
}

TEST(McapDamageTest, CutAnywhereGivesWhatCameBefore) {
  for (const auto& layout : all_layouts()) {
    McapBuilder builder = small_file(layout, 3);
    const std::string whole = builder.finish();
    std::size_t last = 0;
    for (std::size_t size = 8; size <= whole.size(); ++size) {
      const Contents all = read_all(whole.substr(0, size));
      for (const Record& record : all.records) ASSERT_TRUE(test::is_clean(record));
      EXPECT_GE(all.records.size(), last) << size;
      EXPECT_EQ(all.damage.has_value(), size < builder.data_end() + kDataEndSize) << size;
      last = all.records.size();
    }
    EXPECT_EQ(last, 12U);
  }
}

TEST(McapDamageTest, SaysWhereAndHowFar) {
  const McapBuilder::Options flat{std::nullopt, 4, true, true};
  McapBuilder builder = small_file(flat);
  builder.finish();
  const std::string whole = builder.finish();
  const Contents all = read_all(whole.substr(0, builder.data_end() / 2));
  EXPECT_THAT(all.damage.value_or(""),
              testing::MatchesRegex("memory: .* at byte [0-9]+; 0.0 s with [0-9] scans could be read"));
}

TEST(McapDamageTest, PartOfACutChunkIsSaved) {
  McapBuilder file({"zstd", 100'000, true, false});
  const auto scans = file.add_channel("/scan", "sensor_msgs/msg/LaserScan");
  std::mt19937 random(3);
  LaserScanFields fields;
  for (int i = 0; i < 1000; ++i) {
    fields.ranges.clear();
    for (int beam = 0; beam < 360; ++beam)
      fields.ranges.push_back(static_cast<float>(random() % 10'000) * 1e-3F);
    file.add_message(scans, static_cast<std::uint64_t>(i * 100 * kMs), laser_scan(fields));
  }
  const std::string whole = file.finish();
  const Contents all = read_all(whole.substr(0, whole.size() / 2));
  EXPECT_GT(all.scans.size(), 300U);
  EXPECT_LT(all.scans.size(), 600U);
  EXPECT_THAT(all.damage.value_or(""), HasSubstr("the file ends inside a chunk at byte "));
}

/// Two good chunks with something in between.
Contents with_between(const std::string& between, std::optional<std::string> compression = "zstd") {
  McapBuilder file({std::move(compression), 1, true, true});
  const Channels on(file);
  file.add_message(on.scan, 1, scan_at(kStart));
  file.add_outside(between);
  file.add_message(on.scan, 1, scan_at(kStart));
  return read_all(file.finish());
}

TEST(McapDamageTest, ABadChunkCostsThatChunk) {
  const std::string packed = McapBuilder::pack(std::string(100, 'x'), "zstd");
  const struct {
    std::string chunk;
    const char* why;
  } cases[] = {
      {McapBuilder::chunk_record_of("abc", 3, 12345, ""), "checksum"},
      {McapBuilder::chunk_record_of("abc", 3, 0, ""), "past the end of its chunk"},
      {McapBuilder::chunk_record_of("abc", 3, 0, "bzip2"), "not known"},
      {McapBuilder::chunk_record_of("abc", 2, 0, ""), "does not unpack"},
      {McapBuilder::chunk_record_of("abc", 4, 0, ""), "does not unpack"},
      {McapBuilder::chunk_record_of("not zstd at all", 100, 0, "zstd"), "does not unpack"},
      {McapBuilder::chunk_record_of("not lz4 at all", 100, 0, "lz4"), "does not unpack"},
      {McapBuilder::chunk_record_of(packed, 99, 0, "zstd"), "does not unpack"},
      {McapBuilder::chunk_record_of(packed, 101, 0, "zstd"), "does not unpack"},
      {McapBuilder::chunk_record_of(packed.substr(0, packed.size() - 1), 100, 0, "zstd"), "does not unpack"},
      {McapBuilder::chunk_record_of(packed, std::uint64_t{1} << 60, 0, "zstd"), "larger than 256 MiB"},
      {McapBuilder::record(0x06, "short"), "makes no sense"},
      {McapBuilder::record(0x06, std::string(28, '\0') + le(0xFFFF'FFFFU) + "x"), "makes no sense"},
      {McapBuilder::record(0x06, std::string(28, '\0') + le_text("") + le(std::uint64_t{1} << 40)),
       "makes no sense"},
  };
  for (const auto& bad : cases) {
    const Contents all = with_between(bad.chunk);
    EXPECT_EQ(all.scans.size(), 2U) << bad.why;
    EXPECT_THAT(all.damage.value_or(""), HasSubstr(bad.why));
  }
  EXPECT_EQ(with_between(cases[0].chunk).counters["mcap.bad_crc"], 1U);
  EXPECT_EQ(with_between(cases[0].chunk).counters["mcap.lost_chunks"], 1U);
}

TEST(McapDamageTest, ABombIsStoppedAtThePromisedSize) {
  const std::string bomb = McapBuilder::pack(std::string(64 << 20, '\0'), "zstd");
  const Contents all = with_between(McapBuilder::chunk_record_of(bomb, 1000, 0, "zstd"));
  EXPECT_EQ(all.scans.size(), 2U);
  EXPECT_THAT(all.damage.value_or(""), HasSubstr("does not unpack"));
}

TEST(McapDamageTest, UnknownRecordsArePassedOver) {
  const std::string others = McapBuilder::record(0x09, std::string(1000, 'a')) +
                             McapBuilder::record(0x0C, "meta") + McapBuilder::record(0x90, "private") +
                             McapBuilder::chunk_record("", "zstd");
  for (const auto& compression : {std::optional<std::string>("zstd"), std::optional<std::string>()}) {
    const Contents all = with_between(others, compression);
    EXPECT_EQ(all.scans.size(), 2U);
    EXPECT_EQ(all.damage, std::nullopt);
  }
}

TEST(McapDamageTest, ALengthBeyondTheFileEndsIt) {
  const std::string message = '\x05' + le(~std::uint64_t{0}) + "x";
  const Contents all = with_between(message);
  EXPECT_EQ(all.scans.size(), 1U);
  EXPECT_THAT(all.damage.value_or(""), HasSubstr("past the end of the file"));
  const std::string nothing(20, '\0');
  EXPECT_THAT(with_between(nothing).damage.value_or(""), HasSubstr("no record begins here"));
  // A chunk's own sizes still tell where its records are when the length before it is damaged.
  std::string chunk = McapBuilder::chunk_record("", "lz4");
  chunk[6] = '\x7F';
  EXPECT_THAT(with_between(chunk).damage.value_or(""), HasSubstr("ends inside a chunk"));
}

TEST(McapDamageTest, AFileOfMagicAloneIsDamaged) {
  EXPECT_THAT(read_all(McapBuilder::magic()).damage.value_or(""),
              HasSubstr("ends before its end mark at byte 8"));
}

TEST(McapDamageTest, AnyFlippedByteIsHarmless) {
  std::mt19937 random(11);
  for (const auto& layout : all_layouts()) {
    McapBuilder file = small_file(layout);
    const auto tf = file.add_channel("/tf_static", "tf2_msgs/msg/TFMessage");
    file.add_message(tf, 1, transforms({{"base_link", "laser", 0.1, 0.2, 0.3, kUpsideDown}}));
    const std::string whole = file.finish();
    for (int trial = 0; trial < 2000; ++trial) {
      std::string bytes = whole;
      for (int flips = 0; flips <= trial % 4; ++flips) {
        bytes[8 + random() % (bytes.size() - 8)] = static_cast<char>(random());
      }
      const Contents all = read_all(bytes);
      for (const Record& record : all.records) ASSERT_TRUE(test::is_clean(record));
    }
  }
}

TEST(ChunkUnpackerTest, ManySizesThereAndBack) {
  std::mt19937 random(5);
  ChunkUnpacker unpacker;
  for (const std::size_t size : {0, 1, 65'535, 65'536, 65'537, 131'072, 1'000'000, 7, 5'000'000}) {
    std::string bytes(size, '\0');
    for (char& c : bytes) c = static_cast<char>(random() % 5);
    for (const char* compression : {"", "zstd", "lz4"}) {
      MemorySource source(McapBuilder::pack(bytes, compression));
      ASSERT_EQ(unpacker.unpack(source, source.size(), compression, size), UnpackResult::kWhole) << size;
      const Bytes got = unpacker.bytes();
      EXPECT_TRUE(std::string_view(reinterpret_cast<const char*>(got.data()), got.size()) == bytes) << size;
    }
  }
}

TEST(ChunkUnpackerTest, SeveralFramesInARow) {
  ChunkUnpacker unpacker;
  for (const char* compression : {"zstd", "lz4"}) {
    MemorySource source(McapBuilder::pack("abc", compression) + McapBuilder::pack("defg", compression));
    ASSERT_EQ(unpacker.unpack(source, source.size(), compression, 7), UnpackResult::kWhole);
  }
}

}  // namespace
}  // namespace dynslam
