// SPDX-License-Identifier: MIT
#include "io/cdr.h"

#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/ros_messages.h"
#include "io/scan_limits.h"
#include "tests/io/mcap_builder.h"

namespace dynslam {
namespace {

using test::CdrWriter;
using testing::ElementsAre;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Bytes as_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Written by hand from the definition of sensor_msgs/LaserScan, not by the writer of these tests.
constexpr std::uint8_t kGoldenScan[] = {
    0x00, 0x01, 0x00, 0x00,                  // CDR, little-endian
    0x0A, 0x00, 0x00, 0x00,                  // 10 s
    0x00, 0x65, 0xCD, 0x1D,                  // 500 000 000 ns
    0x03, 0x00, 0x00, 0x00, 'l', '1', 0x00,  // frame_id "l1"
    0x00,                                    // to the next multiple of four
    0x00, 0x00, 0x80, 0xBF,                  // angle_min -1
    0x00, 0x00, 0x80, 0x3F,                  // angle_max 1
    0x00, 0x00, 0x80, 0x3F,                  // angle_increment 1
    0x00, 0x00, 0x00, 0x3E,                  // time_increment 0.125
    0x00, 0x00, 0x00, 0x3F,                  // scan_time 0.5
    0x00, 0x00, 0x80, 0x3E,                  // range_min 0.25
    0x00, 0x00, 0x20, 0x41,                  // range_max 10
    0x03, 0x00, 0x00, 0x00,                  // three ranges
    0x00, 0x00, 0x00, 0x40,                  // 2
    0x00, 0x00, 0x20, 0x41,                  // 10: nothing in reach
    0x00, 0x00, 0x00, 0x3E,                  // 0.125: too near
    0x00, 0x00, 0x00, 0x00,                  // no intensities
};

TEST(LaserScanTest, GoldenBytes) {
  const auto scan = decode_laser_scan(kGoldenScan);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->header.frame_id, "l1");
  EXPECT_EQ(scan->value.stamp, Time(std::chrono::milliseconds(10'500)));
  ASSERT_EQ(scan->value.beams.size(), 3U);
  EXPECT_FLOAT_EQ(scan->value.beams[0].angle_rad, -1.0F);
  EXPECT_FLOAT_EQ(scan->value.beams[2].angle_rad, 1.0F);
  EXPECT_FLOAT_EQ(scan->value.beams[2].time_s, 0.25F);
  EXPECT_FLOAT_EQ(scan->value.beams[0].range_m, 2.0F);
  EXPECT_EQ(scan->value.beams[1].range_m, kInf);
  EXPECT_TRUE(std::isnan(scan->value.beams[2].range_m));
}

TEST(LaserScanTest, EveryCutBeforeTheEndOfTheRangesIsNoScan) {
  const Bytes whole(kGoldenScan);
  const std::size_t needed = whole.size() - 4;  // the intensities are not looked at
  for (std::size_t size = 0; size < needed; ++size)
    EXPECT_FALSE(decode_laser_scan(whole.first(size))) << size;
  EXPECT_TRUE(decode_laser_scan(whole.first(needed)));
}

TEST(LaserScanTest, BigEndianSaysTheSame) {
  test::LaserScanFields fields;
  const auto little = decode_laser_scan(as_bytes(test::laser_scan(fields)));
  fields.big_endian = true;
  const auto big = decode_laser_scan(as_bytes(test::laser_scan(fields)));
  ASSERT_TRUE(little && big);
  EXPECT_EQ(little->value.stamp, big->value.stamp);
  ASSERT_EQ(little->value.beams.size(), big->value.beams.size());
  EXPECT_EQ(little->value.beams[2].range_m, big->value.beams[2].range_m);
}

TEST(LaserScanTest, OddRanges) {
  test::LaserScanFields fields;
  fields.ranges = {kNan, kInf, -kInf, 0.0F, -1.0F, 0.05F, 0.1F, 11.9F, 12.0F, 1e30F};
  const auto scan = decode_laser_scan(as_bytes(test::laser_scan(fields)));
  ASSERT_TRUE(scan);
  std::string kinds;
  for (const Beam& beam : scan->value.beams)
    kinds += is_return(beam) ? 'r' : std::isnan(beam.range_m) ? 'n' : 'i';
  EXPECT_EQ(kinds, "ninnnnrrii");
}

TEST(LaserScanTest, LimitsThatADriverLeftUnsetDoNotLimit) {
  for (const float unset : {0.0F, kNan, -1.0F}) {
    test::LaserScanFields fields;
    fields.range_min = fields.range_max = unset;
    const auto scan = decode_laser_scan(as_bytes(test::laser_scan(fields)));
    ASSERT_TRUE(scan);
    EXPECT_TRUE(is_return(scan->value.beams[2]));
  }
}

TEST(LaserScanTest, AnglesAndTimesThatCannotBe) {
  const auto decodes = [](auto change) {
    test::LaserScanFields fields;
    change(fields);
    return decode_laser_scan(as_bytes(test::laser_scan(fields))).has_value();
  };
  for (const float odd : {kNan, kInf, 1e30F}) {
    EXPECT_FALSE(decodes([&](auto& f) { f.angle_min = odd; }));
    EXPECT_FALSE(decodes([&](auto& f) { f.angle_increment = odd; }));
    EXPECT_FALSE(decodes([&](auto& f) { f.time_increment = odd; }));
  }
  EXPECT_FALSE(decodes([](auto& f) { f.time_increment = -0.001F; }));
  EXPECT_TRUE(decodes([](auto& f) { f.time_increment = 0.0F; }));
  EXPECT_TRUE(decodes([](auto& f) { f.angle_increment = -0.5F; }));
  EXPECT_TRUE(decodes([](auto& f) { f.ranges.assign(100, 1.0F); }));  // eight turns
}

TEST(LaserScanTest, ZeroAndAMillionBeams) {
  test::LaserScanFields fields;
  fields.ranges.clear();
  EXPECT_EQ(decode_laser_scan(as_bytes(test::laser_scan(fields)))->value.beams.size(), 0U);
  fields.ranges.assign(1'000'000, 2.0F);
  fields.angle_increment = fields.time_increment = 1e-6F;
  EXPECT_EQ(decode_laser_scan(as_bytes(test::laser_scan(fields)))->value.beams.size(), 1'000'000U);
  fields.ranges.assign(kMaxBeams + 1, 2.0F);
  EXPECT_FALSE(decode_laser_scan(as_bytes(test::laser_scan(fields))));
}

TEST(CdrReaderTest, AlignsFromBehindTheHeader) {
  const std::string bytes =
      CdrWriter().put(std::uint8_t{7}).put(2.5).put(std::uint16_t{9}).text("ab").bytes();
  CdrReader cdr(as_bytes(bytes));
  EXPECT_EQ(cdr.number<std::uint8_t>(), 7);
  EXPECT_EQ(cdr.number<double>(), 2.5);
  EXPECT_EQ(cdr.number<std::uint16_t>(), 9);
  EXPECT_EQ(cdr.text(), "ab");
  EXPECT_TRUE(cdr.ok());
  EXPECT_EQ(cdr.number<double>(), 0.0);
  EXPECT_FALSE(cdr.ok());
  EXPECT_EQ(cdr.text(), "");
}

TEST(CdrReaderTest, CountsBeyondTheMessageTakeNothing) {
  const std::string bytes = CdrWriter().put(0xFFFF'FFFFU).put(1.0F).bytes();
  CdrReader floats(as_bytes(bytes));
  EXPECT_THAT(floats.floats(1'000'000'000'000U), ElementsAre());
  EXPECT_FALSE(floats.ok());
  CdrReader text(as_bytes(bytes));
  EXPECT_EQ(text.text(), "");
  EXPECT_FALSE(text.ok());
}

TEST(CdrReaderTest, OnlyPlainCdr) {
  for (const std::string& head : {std::string("\0\2\0\0", 4), std::string("\0\7\0\0", 4),
                                  std::string("\1\1\0\0", 4), std::string("\0\1", 2), std::string()}) {
    EXPECT_FALSE(CdrReader(as_bytes(head)).ok());
  }
  EXPECT_TRUE(CdrReader(as_bytes(std::string("\0\1\0\0", 4))).ok());
}

TEST(ImuMessageTest, NormalisesWhatIsNearUnitLength) {
  ImuFault fault = ImuFault::kNone;
  const std::string bytes = test::imu(2'000'000'001, {0.0, 0.0, 0.707, 0.707});
  const auto imu = decode_imu(as_bytes(bytes), fault);
  EXPECT_EQ(fault, ImuFault::kNone);
  EXPECT_EQ(imu.header.stamp, Time(Duration(2'000'000'001)));
  EXPECT_NEAR(imu.value.norm(), 1.0, 1e-12);
  EXPECT_NEAR(yaw_of(imu.value), kPi / 2.0, 1e-9);
}

TEST(ImuMessageTest, Faults) {
  const auto fault_of = [](const std::string& bytes) {
    ImuFault fault = ImuFault::kNone;
    decode_imu(as_bytes(bytes), fault);
    return std::string(name_of(fault));
  };
  EXPECT_EQ(fault_of(test::imu(1, {})), "");
  EXPECT_EQ(fault_of(test::imu(1, {}, -1.0)), "imu.no_orientation");
  EXPECT_EQ(fault_of(test::imu(1, {0, 0, 0, 0})), "imu.bad_quaternion");
  EXPECT_EQ(fault_of(test::imu(1, {0, 0, 0, 1.2})), "imu.bad_quaternion");
  EXPECT_EQ(fault_of(test::imu(1, {0, kNan, 0, 1})), "imu.bad_quaternion");
  EXPECT_EQ(fault_of(test::imu(1, {0, kInf, 0, 1})), "imu.bad_quaternion");
  EXPECT_EQ(fault_of(test::imu(1, {}).substr(0, 40)), "imu.bad");
}

TEST(OdometryMessageTest, IsProjectedToThePlane) {
  const std::string bytes = test::odometry(5, 1.5, -2.0, {0, 0, std::sin(0.4), std::cos(0.4)});
  const auto odometry = decode_odometry(as_bytes(bytes));
  ASSERT_TRUE(odometry);
  EXPECT_EQ(odometry->value.x, 1.5);
  EXPECT_EQ(odometry->value.y, -2.0);
  EXPECT_NEAR(odometry->value.yaw, 0.8, 1e-9);
  EXPECT_FALSE(decode_odometry(as_bytes(bytes.substr(0, 60))));
  EXPECT_FALSE(decode_odometry(as_bytes(test::odometry(5, kNan, 0, {}))));
  EXPECT_FALSE(decode_odometry(as_bytes(test::odometry(5, 0, 0, {0, 0, 0, 0}))));
}

}  // namespace
}  // namespace dynslam
