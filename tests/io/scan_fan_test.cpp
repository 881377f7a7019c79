// SPDX-License-Identifier: MIT
#include "io/scan_fan.h"

#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "io/ros_encoding.h"
#include "io/ros_messages.h"

namespace dynslam {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// As a recording of ours is read.
Scan there_and_back(const Scan& scan) {
  const std::string message = encode_laser_scan(scan, "laser");
  auto read = decode_laser_scan({reinterpret_cast<const std::uint8_t*>(message.data()), message.size()});
  EXPECT_TRUE(read);
  if (!read) return {};
  read->value.stamp = read->header.stamp;
  drop_gaps(read->value);
  return read->value;
}

/// A turn of an RPLIDAR, whose steps are by far not equal.
Scan uneven_turn(std::uint32_t seed, double side = 1.0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.4, 0.4);
  Scan scan{Time(std::chrono::seconds(7)), {}, {}};
  for (int i = 0; i < 1600; ++i) {
    const double share = (i + jitter(random)) / 1600.0;
    const double angle = wrap_angle(1.0 + side * kTwoPi * share);
    scan.beams.push_back({static_cast<float>(angle), 1.0F + static_cast<float>(i) * 0.01F,
                          static_cast<float>(0.1 * (share + 0.4 / 1600.0))});
  }
  return scan;
}

TEST(ScanFan, EqualStepsStayWhatTheyAre) {
  Scan scan;
  for (int i = 0; i < 360; ++i)
    scan.beams.push_back(
        {static_cast<float>(radians(i - 180.0)), i == 5 ? kNan : 3.0F, static_cast<float>(i) * 1e-4F});
  const ScanFan fan = to_fan(scan);
  EXPECT_EQ(fan.ranges_m.size(), 360U);
  const Scan back = there_and_back(scan);
  ASSERT_EQ(back.beams.size(), 360U);
  EXPECT_TRUE(std::isnan(back.beams[5].range_m)) << "an invalid beam is not a gap";
  for (std::size_t i = 0; i < 360; ++i) {
    EXPECT_NEAR(back.beams[i].angle_rad, scan.beams[i].angle_rad, 5e-7);
    EXPECT_NEAR(back.beams[i].time_s, scan.beams[i].time_s, 1e-8);
  }
}

TEST(ScanFan, UnequalStepsMoveByAQuarterOfAMilliradianAtMost) {
  for (const double side : {1.0, -1.0}) {
    const Scan scan = uneven_turn(3, side);
    const Scan back = there_and_back(scan);
    ASSERT_EQ(back.beams.size(), scan.beams.size()) << "none fell together, none was added";
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      EXPECT_LE(std::abs(turn(back.beams[i].angle_rad, scan.beams[i].angle_rad)), 2.6e-4) << i;
      EXPECT_EQ(back.beams[i].range_m, scan.beams[i].range_m) << i;
      EXPECT_NEAR(to_seconds(back.stamp - scan.stamp) + static_cast<double>(back.beams[i].time_s),
                  static_cast<double>(scan.beams[i].time_s), 1e-5)
          << i;
    }
  }
}

TEST(ScanFan, OfTwoBeamsAtOnePlaceTheNearerIsKept) {
  Scan scan;
  scan.beams = {{0.0F, 5.0F, 0.0F}, {1e-7F, kInf, 0.0F}, {2e-7F, 2.0F, 0.0F}, {1.0F, kInf, 0.1F}};
  const ScanFan fan = to_fan(scan);
  EXPECT_EQ(fan.ranges_m.front(), 2.0F);
  EXPECT_EQ(fan.ranges_m.back(), kInf);
  EXPECT_LE(fan.ranges_m.size(), 4U * 16U);
}

TEST(ScanFan, TakesWhatNoLidarGives) {
  EXPECT_TRUE(to_fan({}).ranges_m.empty());
  Scan scan;
  scan.beams = {{kNan, 1.0F, 0.0F}, {0.0F, 1.0F, kInf}};
  EXPECT_TRUE(to_fan(scan).ranges_m.empty());
  scan.beams = {{2.0F, 1.5F, 0.25F}};
  EXPECT_EQ(to_fan(scan).ranges_m, std::vector<float>{1.5F});
  EXPECT_EQ(to_fan(scan).stamp, Time(std::chrono::milliseconds(250)));
  scan.beams = {{2.0F, 1.5F, 0.0F}, {2.0F, 1.2F, 0.1F}};
  EXPECT_EQ(to_fan(scan).ranges_m, std::vector<float>{1.2F});
}

TEST(ScanFan, NeverGrowsBeyondSixteenReadingsABeam) {
  std::mt19937 random(5);
  const std::vector<float> odd = {0.0F, -0.0F, 3.2F, -3.2F, 1e-30F, 1e6F, 100.0F, 1e-6F};
  for (int round = 0; round < 500; ++round) {
    Scan scan;
    for (std::size_t i = 0; i < random() % 50; ++i) {
      const auto pick = [&] { return odd[random() % odd.size()] * static_cast<float>(random() % 7); };
      scan.beams.push_back({pick(), pick(), pick()});
    }
    const ScanFan fan = to_fan(scan);
    ASSERT_LE(fan.ranges_m.size(), 16 * scan.beams.size() + 1);
    ASSERT_TRUE(std::isfinite(fan.first_rad) && std::isfinite(fan.step_rad) && fan.time_step_s >= 0.0F);
  }
}

TEST(ScanFan, RangesFartherThanAnyLidarSeesAreKept) {
  Scan scan;
  scan.beams = {{0.0F, 250.0F, 0.0F}, {0.1F, 3.0F, 0.0F}, {0.2F, kInf, 0.0F}};
  const Scan back = there_and_back(scan);
  EXPECT_EQ(back.beams.at(0).range_m, 250.0F);
  EXPECT_EQ(back.beams.at(2).range_m, kInf);
}

}  // namespace
}  // namespace dynslam
