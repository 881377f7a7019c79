// SPDX-License-Identifier: MIT
#include <algorithm>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "base/error.h"
#include "io/line_reader.h"
#include "io/scan_limits.h"
#include "tests/io/read_all.h"

namespace dynslam {
namespace {

using test::Contents;
using test::read_all;
using testing::HasSubstr;

constexpr char kTail[] = " 1 2 3 4 5 0.5 12.25 host 0.1\n";  // corrected pose, raw pose, stamp

std::string flaser(const std::string& readings) {
  const auto count = static_cast<std::size_t>(std::count(readings.begin(), readings.end(), ' '));
  return "FLASER " + std::to_string(readings.empty() ? 0 : count + 1) + " " + readings + kTail;
}

std::string flaser_of(std::size_t beams, const std::string& reading = "1.5") {
  std::string line = "FLASER " + std::to_string(beams);
  for (std::size_t i = 0; i < beams; ++i) line += " " + reading;
  return line + kTail;
}

/// A fan of `count` readings of 2 m with the poses `laser` and `robot`, each "x y theta".
std::string robotlaser(const std::string& fan, int count, const std::string& laser,
                       const std::string& robot) {
  std::string line = "ROBOTLASER1 0 " + fan + " 0.01 0 " + std::to_string(count);
  for (int i = 0; i < count; ++i) line += " 2.0";
  return line + " 2 77 78 " + laser + " " + robot + " 0.1 0.2 0.3 0.4 0.5 99.5 host 1.0\n";
}

std::string gzip(const std::string& text) {
  std::string packed(compressBound(text.size()) + 64, '\0');
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

double first_angle(const Contents& contents) { return contents.scans.at(0).beams.at(0).angle_rad; }
double last_angle(const Contents& contents) { return contents.scans.at(0).beams.back().angle_rad; }

TEST(CarmenLogTest, FlaserGivesRawOdometryAndThenTheScan) {
  const Contents log = read_all(flaser("1.0 2.0 3.0"));
  ASSERT_EQ(log.records.size(), 2U);
  const auto& odometry = std::get<OdometrySample>(log.records[0]);
  EXPECT_EQ(odometry.odom_T_robot, (Pose2{4.0, 5.0, 0.5}));
  EXPECT_EQ(odometry.stamp, time_at_s(12.25));
  const auto& scan = std::get<Scan>(log.records[1]);
  EXPECT_EQ(scan.stamp, time_at_s(12.25));
  ASSERT_EQ(scan.beams.size(), 3U);
  EXPECT_FLOAT_EQ(scan.beams[0].angle_rad, static_cast<float>(-kPi / 2.0));
  EXPECT_FLOAT_EQ(scan.beams[1].angle_rad, 0.0F);
  EXPECT_FLOAT_EQ(scan.beams[2].angle_rad, static_cast<float>(kPi / 2.0));
  EXPECT_FLOAT_EQ(scan.beams[2].range_m, 3.0F);
  EXPECT_EQ(scan.beams[2].time_s, 0.0F);
  EXPECT_EQ(log.damage, std::nullopt);
  EXPECT_TRUE(log.counters.empty());
}

TEST(CarmenLogTest, OdomIsWrapped) {
  const Contents log = read_all("ODOM 1.5 -2 7.0 0 0 0 3.5 host 0.1\n");
  ASSERT_EQ(log.odometry.size(), 1U);
  EXPECT_NEAR(log.odometry[0].odom_T_robot.yaw, 7.0 - kTwoPi, 1e-12);
  EXPECT_EQ(log.odometry[0].stamp, time_at_s(3.5));
}

TEST(CarmenLogTest, FanOfASick) {
  for (const std::size_t whole : {181, 361, 91}) {
    const Contents log = read_all(flaser_of(whole));
    EXPECT_NEAR(first_angle(log), -kPi / 2.0, 1e-6) << whole;
    EXPECT_NEAR(last_angle(log), kPi / 2.0, 1e-6) << whole;
  }
  EXPECT_NEAR(last_angle(read_all(flaser_of(180))), radians(89.0), 1e-6);
  EXPECT_NEAR(last_angle(read_all(flaser_of(360))), radians(89.5), 1e-6);
  EXPECT_NEAR(first_angle(read_all(flaser_of(180))), radians(-90.0), 1e-6);
  EXPECT_NEAR(last_angle(read_all(flaser_of(401))), radians(50.0), 1e-6);
  EXPECT_NEAR(last_angle(read_all(flaser_of(400))), radians(49.75), 1e-6);
  EXPECT_EQ(first_angle(read_all(flaser_of(1))), 0.0);
}

TEST(CarmenLogTest, FieldOfViewFromAParam) {
  const std::string param = "PARAM laser_front_laser_fov ";
  EXPECT_NEAR(last_angle(read_all(param + "1.0 0 h 0\n" + flaser_of(11))), 0.5, 1e-6);
  EXPECT_NEAR(last_angle(read_all(param + "270 0 h 0\n" + flaser_of(11))), radians(135.0), 1e-6);
  EXPECT_NEAR(last_angle(read_all(param + "3.124 0 h 0\n" + flaser_of(180))), radians(89.0), 1e-6);
  EXPECT_NEAR(last_angle(read_all(param + "1000 0 h 0\n" + flaser_of(11))), kPi / 2.0, 1e-6);
  const Contents bad = read_all(param + "wide 0 h 0\n" + flaser_of(11));
  EXPECT_NEAR(last_angle(bad), kPi / 2.0, 1e-6);
  EXPECT_EQ(bad.counters["carmen.bad_lines"], 1U);
}

TEST(CarmenLogTest, RangesBecomeReturnsNoReturnsOrInvalid) {
  const auto kinds_of = [](const std::string& log) {
    std::string kinds;
    const Contents contents = read_all(log);
    for (const Beam& beam : contents.scans.at(0).beams) {
      kinds += is_return(beam) ? 'r' : std::isnan(beam.range_m) ? 'n' : 'i';
    }
    return kinds;
  };
  const std::string line = flaser("81.91 80.0 79.9 50.0 49.9 0 -1 nan inf -inf 0.01");
  EXPECT_EQ(kinds_of(line), "iirrrnnninr");
  EXPECT_EQ(kinds_of("PARAM robot_front_laser_max 50 0 h 0\n" + line), "iiiirnnninr");
  EXPECT_EQ(kinds_of("PARAM laser_front_laser_max 200 0 h 0\n" + line), "iirrrnnninr");
}

TEST(CarmenLogTest, MountFromParamsUnlessConfigured) {
  const std::string log =
      "PARAM robot_frontlaser_offset 0.25 0 h 0\nPARAM laser_front_laser_flipped 1 0 h 0\n" + flaser("1 2");
  const LidarMount mount = read_all(log).scans.at(0).mount;
  EXPECT_EQ(mount.robot_T_lidar, (Pose2{0.25, 0.0, 0.0}));
  EXPECT_TRUE(mount.upside_down);

  RecordingConfig config;
  config.lidar_mount.robot_T_lidar = {-0.1, 0.2, 0.3};
  const LidarMount configured = read_all(log, config).scans.at(0).mount;
  EXPECT_EQ(configured.robot_T_lidar, config.lidar_mount.robot_T_lidar);
  EXPECT_FALSE(configured.upside_down);
}

TEST(CarmenLogTest, RobotlaserSaysItsFanAndMount) {
  const Contents log =
      read_all(robotlaser("-0.5 1.0 0.25 30", 3, "1 3 1.5707963267948966", "1 2 1.5707963267948966"));
  ASSERT_EQ(log.scans.size(), 1U);
  EXPECT_NEAR(first_angle(log), -0.5, 1e-6);
  EXPECT_NEAR(last_angle(log), 0.0, 1e-6);
  EXPECT_EQ(log.scans[0].stamp, time_at_s(99.5));
  EXPECT_NEAR(log.scans[0].mount.robot_T_lidar.x, 1.0, 1e-9);
  EXPECT_NEAR(log.scans[0].mount.robot_T_lidar.y, 0.0, 1e-9);
  EXPECT_EQ(log.odometry.at(0).odom_T_robot.y, 2.0);
}

TEST(CarmenLogTest, RobotlaserWithWhatItLeavesOut) {
  const std::string param = "PARAM robot_frontlaser_offset 0.25 0 h 0\n";
  const Contents same_pose = read_all(param + robotlaser("-0.5 1.0 0 1.0", 3, "1 2 0.5", "1 2 0.5"));
  EXPECT_NEAR(last_angle(same_pose), 0.5, 1e-6);               // from the field of view
  EXPECT_FALSE(is_return(same_pose.scans.at(0).beams.at(0)));  // 2 m is over the maximum of 1 m
  EXPECT_EQ(same_pose.scans[0].mount.robot_T_lidar.x, 0.25);
  const Contents far = read_all(param + robotlaser("-0.5 1.0 0.5 0", 3, "1000 2 0.5", "1 2 0.5"));
  EXPECT_EQ(far.scans.at(0).mount.robot_T_lidar.x, 0.25);
  EXPECT_EQ(far.counters["carmen.bad_mount"], 1U);
  EXPECT_TRUE(is_return(far.scans[0].beams.at(0)));
}

TEST(CarmenLogTest, TheFirstLaserMessageThatWorksIsUsed) {
  const std::string robot = robotlaser("-0.5 1.0 0.5 30", 3, "0 0 0", "0 0 0");
  const Contents log = read_all("FLASER 3 1 2\n" + robot + flaser("1 2 3") + robot);
  EXPECT_EQ(log.scans.size(), 2U);
  EXPECT_EQ(log.counters["carmen.skipped.FLASER"], 1U);
  EXPECT_EQ(log.counters["carmen.bad_lines"], 1U);
}

TEST(CarmenLogTest, OtherMessagesAreCountedByName) {
  std::string text = "# a comment\n\n" + flaser("1 2") + "RLASER 1 2\nSYNC x\nSYNC y\n";
  for (int i = 0; i < 100; ++i) text += "NAME" + std::to_string(i) + "\n";
  text += "\x01\xFF!\n";
  const Contents log = read_all(text);
  EXPECT_EQ(log.counters["carmen.skipped.RLASER"], 1U);
  EXPECT_EQ(log.counters["carmen.skipped.SYNC"], 2U);
  EXPECT_GT(log.counters["carmen.skipped.other"], 60U);
  EXPECT_EQ(log.counters["carmen.bad_lines"], 0U);
  EXPECT_LT(std::distance(log.counters.begin(), log.counters.end()), 40);
}

TEST(CarmenLogTest, ABadLineCostsThatLineOnly) {
  const char* const bad_lines[] = {"FLASER",
                                   "FLASER x",
                                   "FLASER -3 1 2 3 0 0 0 0 0 0 1 h 1",
                                   "FLASER 3 1 2 3 0 0 0 0 0 0",
                                   "FLASER 3 1 2 3m 0 0 0 0 0 0 1 h 1",
                                   "FLASER 3 1 2,5 3 0 0 0 0 0 0 1 h 1",
                                   "FLASER 99999999999999999999999 1",
                                   "FLASER 18446744073709551615 1 2 3 0 0 0 0 0 0 1 h 1",
                                   "FLASER 4000000000 1 2 3 0 0 0 0 0 0 1 h 1",
                                   "FLASER 3 1 2 3 0 0 0 0 0 0 1e300 h 1",
                                   "FLASER 3 1 2 3 0 0 0 0 0 0 nan h 1",
                                   "ODOM 1 2",
                                   "ODOM 1 2 3 0 0 0 inf h 1",
                                   "ROBOTLASER1 0 1",
                                   "ROBOTLASER1 0 -1 2 1 30 0.01 0 1 2.0 5000000000 0 0",
                                   "ROBOTLASER1 0 1e30 2 1 30 0.01 0 1 2.0 0 0 0 0 0 0 0 0 0 0 0 0 1 h 1",
                                   "ROBOTLASER1 0 0 2 nan 30 0.01 0 1 2.0 0 0 0 0 0 0 0 0 0 0 0 0 1 h 1"};
  for (const char* bad : bad_lines) {
    const bool is_flaser = std::string_view(bad).starts_with("FLASER");
    const std::string good = is_flaser ? flaser("1 2 3") : robotlaser("-0.5 1.0 0.5 30", 3, "0 0 0", "0 0 0");
    const Contents log = read_all(good + bad + "\n" + good);
    EXPECT_EQ(log.scans.size(), 2U) << bad;
    EXPECT_EQ(log.counters["carmen.bad_lines"], 1U) << bad;
    EXPECT_EQ(log.damage, std::nullopt) << bad;
  }
}

TEST(CarmenLogTest, WithoutAnyScanTheFirstBadLineIsNamed) {
  const Contents log = read_all("PARAM a b\nODOM 1 2 3 0 0 0 1 h 1\nFLASER 5 1 2\nFLASER 5 1\n");
  ASSERT_TRUE(log.damage);
  EXPECT_THAT(*log.damage, HasSubstr("memory: no scan could be read; the first damaged line is number 3"));
  EXPECT_EQ(log.odometry.size(), 1U);
}

TEST(CarmenLogTest, NonFiniteOdometryIsDroppedButNotItsScan) {
  const Contents log = read_all("FLASER 1 2.0 0 0 0 nan 0 0 1 h 1\nODOM inf 0 0 0 0 0 1 h 1\n");
  EXPECT_EQ(log.scans.size(), 1U);
  EXPECT_EQ(log.odometry.size(), 0U);
  EXPECT_EQ(log.counters["carmen.bad_odometry"], 2U);
}

TEST(CarmenLogTest, LineEndings) {
  std::string text = flaser("1 2 3") + flaser("1 2 3");
  text.pop_back();
  EXPECT_EQ(read_all(text).scans.size(), 2U);  // whole, but for its newline
  std::string dos;
  for (const char c : text) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read_all(dos).scans.size(), 2U);
  EXPECT_EQ(read_all("FLASER\t2  1\t2 0 0 0 0 0 0 1 h 1\n").scans.size(), 1U);
}

TEST(CarmenLogTest, AStampCutShortIsNotBelieved) {
  const std::string text = flaser("1 2 3") + "ODOM 1 2 3 0 0 0 123.4";
  const Contents log = read_all(text);
  EXPECT_EQ(log.odometry.size(), 1U);
  EXPECT_EQ(log.counters["carmen.bad_lines"], 1U);
  EXPECT_EQ(read_all(text + "\n").odometry.size(), 2U);  // a whole line may lack host and logger stamp
}

TEST(CarmenLogTest, ZeroAndAMillionBeams) {
  EXPECT_EQ(read_all("FLASER 0 0 0 0 0 0 0 1 h 1\n").scans.at(0).beams.size(), 0U);
  const Contents log = read_all(flaser_of(1'000'000) + flaser_of(3));
  EXPECT_EQ(log.scans.at(0).beams.size(), 1'000'000U);
  EXPECT_EQ(log.scans.at(1).beams.size(), 3U);
  EXPECT_EQ(read_all(flaser_of(kMaxBeams + 1, "1") + flaser_of(3)).counters["carmen.bad_lines"], 1U);
}

TEST(CarmenLogTest, AnEndlessLineIsSkippedInBoundedMemory) {
  const std::string text =
      gzip(flaser("1 2") + "FLASER " + std::string(3 * LineReader::kMaxLine, '1') + "\n" + flaser("1 2"));
  const Contents log = read_all(text);
  EXPECT_EQ(log.scans.size(), 2U);
  EXPECT_EQ(log.counters["carmen.bad_lines"], 1U);
  const Contents unended = read_all(gzip(flaser("1 2") + std::string(2 * LineReader::kMaxLine, 'x')));
  EXPECT_EQ(unended.scans.size(), 1U);
}

TEST(CarmenLogTest, TimeMayRunBackwards) {
  const Contents log = read_all("ODOM 0 0 0 0 0 0 5 h 1\nODOM 0 0 0 0 0 0 -3.5 h 1\n");
  EXPECT_EQ(log.odometry.at(1).stamp, time_at_s(-3.5));
}

TEST(CarmenLogTest, Gzip) {
  const std::string text = flaser_of(361) + flaser_of(361);
  EXPECT_EQ(read_all(gzip(text)).scans.size(), 2U);
  EXPECT_EQ(read_all(gzip(text) + gzip(text)).scans.size(), 4U);
  const Contents padded = read_all(gzip(text) + std::string(100, '\0'));
  EXPECT_EQ(padded.scans.size(), 2U);
  EXPECT_EQ(padded.damage, std::nullopt);
  const Contents trailed = read_all(gzip(text) + "rubbish");
  EXPECT_EQ(trailed.scans.size(), 2U);
  EXPECT_THAT(trailed.damage.value_or(""), HasSubstr("something other than gzip data follows"));
}

TEST(CarmenLogTest, CutGzipGivesWhatCameBefore) {
  std::mt19937 random(1);
  std::string text;
  for (int i = 0; i < 3000; ++i)
    text += flaser(std::to_string(random() % 1000) + " " + std::to_string(random() % 1000));
  const std::string packed = gzip(text);
  const Contents log = read_all(packed.substr(0, packed.size() / 2));
  EXPECT_GT(log.scans.size(), 1000U);
  EXPECT_LT(log.scans.size(), 2000U);
  EXPECT_THAT(log.damage.value_or(""), HasSubstr("memory: the gzip data is cut off at byte " +
                                                 std::to_string(packed.size() / 2) + ", after "));
  EXPECT_THAT(log.damage.value_or(""), HasSubstr(std::to_string(log.scans.size()) + " scans"));
}

TEST(CarmenLogTest, ProgressGoesFromNothingToOne) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += flaser_of(181);
  const auto log = open_recording(std::make_unique<MemorySource>(text));
  double last = log->progress();
  EXPECT_LT(last, 0.5);
  while (log->next()) {
    EXPECT_GE(log->progress(), last);
    last = log->progress();
  }
  EXPECT_EQ(log->progress(), 1.0);
  EXPECT_FALSE(log->next());
}

void expect_harmless(const std::string& bytes) {
  try {
    const Contents log = read_all(bytes);
    for (const Record& record : log.records) ASSERT_TRUE(test::is_clean(record));
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("memory: "));
  }
}

TEST(CarmenLogTest, EveryCutAndAnyFlippedByteIsHarmless) {
  const std::string plain = "PARAM robot_front_laser_max 50 0 h 0\n" + flaser("1.25 2.5 81.9") +
                            "ODOM 1 2 3 0 0 0 4 h 1\n" +
                            robotlaser("-0.5 1.0 0.5 30", 3, "1 2.5 0", "1 2 0") + flaser("1 2");
  for (const std::string& whole : {plain, gzip(plain)}) {
    for (std::size_t size = 0; size < whole.size(); ++size) expect_harmless(whole.substr(0, size));
    std::mt19937 random(7);
    for (int trial = 0; trial < 2000; ++trial) {
      std::string bytes = whole;
      for (int flips = 0; flips <= trial % 4; ++flips)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      expect_harmless(bytes);
    }
  }
}

}  // namespace
}  // namespace dynslam
