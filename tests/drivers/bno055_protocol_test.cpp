// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/imu_sample.h"
#include "drivers/bno055/calibration_profile.h"
#include "drivers/bno055/motion_check.h"
#include "drivers/bno055/protocol.h"

namespace dynslam::bno055 {
namespace {

using std::chrono::milliseconds;

constexpr double kRightAngle = 3.14159265358979 / 2;

// Turned left by 90 degrees, still turning left by 90 degrees a second: gyroscope 0 0 1440 (05a0), Euler
// heading 270 * 16 = 4320 (10e0), quaternion cos 45 = 11585 (2d41) 0 0 sin 45.
constexpr MotionBytes kTurnedLeft{0, 0, 0,    0,    0xa0, 0x05, 0xe0, 0x10, 0,    0,
                                  0, 0, 0x41, 0x2d, 0,    0,    0,    0,    0x41, 0x2d};

// 27 C; calibrated 3 3 2 0; self-tests passed; fusing; no error; IMU mode.
constexpr StatusBytes kFusing{27, 0xf8, 0x0f, 0, 0, 5, 0, 0, 0, 8};

Motion motion(double yaw_rad, double yaw_radps = 0.0) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())), {0, 0, yaw_radps}};
}

TEST(Bno055Protocol, ReadsOrientationAndRate) {
  const MotionReading reading = decode_motion(kTurnedLeft);
  ASSERT_EQ(reading.nonsense, Nonsense::kNone);
  EXPECT_NEAR(yaw_of(reading.motion.world_q_robot), kRightAngle, 1e-4);
  EXPECT_NEAR(reading.motion.rate_radps.z(), kRightAngle, 1e-9);
  EXPECT_EQ(reading.motion.rate_radps.x(), 0.0);
}

TEST(Bno055Protocol, ReadsNegativeNumbers) {
  MotionBytes right = kTurnedLeft;
  right[4] = 0x60, right[5] = 0xfa;    // -1440
  right[18] = 0xbf, right[19] = 0xd2;  // -11585
  const Motion m = decode_motion(right).motion;
  EXPECT_NEAR(yaw_of(m.world_q_robot), -kRightAngle, 1e-4);
  EXPECT_NEAR(m.rate_radps.z(), -kRightAngle, 1e-9);
}

TEST(Bno055Protocol, RefusesWhatIsNoOrientation) {
  MotionBytes bytes{};
  EXPECT_EQ(decode_motion(bytes).nonsense, Nonsense::kAllZero);
  bytes.fill(0xff);
  EXPECT_EQ(decode_motion(bytes).nonsense, Nonsense::kAllOnes);
  bytes = kTurnedLeft;
  for (std::size_t i = 0; i < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
  EXPECT_EQ(decode_motion(bytes).nonsense, Nonsense::kLength) << "low and high bytes swapped";
  bytes = kTurnedLeft;
  bytes[5] = 0x80;
  EXPECT_EQ(decode_motion(bytes).nonsense, Nonsense::kRate) << "80a0 is -2038 degrees a second";
}

TEST(Bno055Protocol, AFlippedBitGivesAUnitQuaternionOrNothing) {
  int found = 0;
  for (std::size_t bit = 0; bit < 8 * kTurnedLeft.size(); ++bit) {
    MotionBytes bytes = kTurnedLeft;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1 << bit % 8);
    const MotionReading reading = decode_motion(bytes);
    found += reading.nonsense != Nonsense::kNone;
    EXPECT_NEAR(reading.motion.world_q_robot.norm(), 1.0, 1e-12) << bit;
    EXPECT_LT(reading.motion.rate_radps.norm(), 61.0) << bit;
  }
  EXPECT_GE(found, 12) << "the higher bits of each part of the quaternion";
}

TEST(Bno055Protocol, ReadsTheStatus) {
  const Status s = decode_status(kFusing).value();
  EXPECT_EQ(s.temperature_c, 27);
  EXPECT_EQ(s.calibration.system, 3);
  EXPECT_EQ(s.calibration.gyroscope, 3);
  EXPECT_EQ(s.calibration.accelerometer, 2);
  EXPECT_EQ(s.calibration.magnetometer, 0);
  EXPECT_TRUE(s.self_tests_passed);
  EXPECT_TRUE(s.is_fusing(kImuMode));
  EXPECT_FALSE(s.is_fusing(kNdofMode));
  StatusBytes cold = kFusing;
  cold[0] = 0xf6;
  EXPECT_EQ(decode_status(cold)->temperature_c, -10);
}

TEST(Bno055Protocol, RefusesAStatusThatCannotBe) {
  StatusBytes bytes{};
  EXPECT_FALSE(decode_status(bytes));
  bytes.fill(0xff);
  EXPECT_FALSE(decode_status(bytes));
  bytes = kFusing;
  bytes[0] |= 0x80;
  EXPECT_FALSE(decode_status(bytes)) << "27 C read as -101";
  for (std::size_t bit = 0; bit < 8 * kFusing.size(); ++bit) {
    bytes = kFusing;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1 << bit % 8);
    if (const auto s = decode_status(bytes)) {
      EXPECT_LE(s->system, 6);
      EXPECT_FALSE(error_words(s->error).empty());
    }
  }
}

TEST(Bno055Protocol, ReadsTheIdentity) {
  const Identity id = decode_identity({0xa0, 0xfb, 0x32, 0x0f, 0x11, 0x03, 0x15});
  EXPECT_TRUE(id.is_usual());
  EXPECT_EQ(id.software, 0x0311);
  EXPECT_EQ(id.bootloader, 0x15);
  EXPECT_FALSE(decode_identity({0xa0, 0xfb, 0x33, 0x0f, 0, 0, 0}).is_usual());
}

TEST(Bno055Protocol, MapsTheAxesAsTheDataSheetsPlacements) {
  const auto is = [](const char* forward, const char* up, int map, int signs) {
    const AxisMap expected{static_cast<std::uint8_t>(map), static_cast<std::uint8_t>(signs)};
    EXPECT_EQ(axis_map(forward, up), expected) << forward << ' ' << up;
  };
  is("-y", "z", 0x21, 0x04);   // P0
  is("x", "z", 0x24, 0x00);    // P1
  is("-x", "z", 0x24, 0x06);   // P2
  is("y", "z", 0x21, 0x02);    // P3
  is("x", "-z", 0x24, 0x03);   // P4
  is("y", "-z", 0x21, 0x01);   // P5
  is("-y", "-z", 0x21, 0x07);  // P6
  is("-x", "-z", 0x24, 0x05);  // P7
}

TEST(Bno055Protocol, RefusesAxesThatAreNone) {
  for (const char* wrong : {"", "w", "+x", "xx", "--x", "-", "z", "-z", "X "})
    EXPECT_FALSE(axis_map(wrong, "z")) << wrong;
}

TEST(Bno055Profile, ReadsWhatItWrote) {
  Profile profile{0xec, 0xff, 0xa5, 0x00, 0xe8, 0xff};
  profile[18] = 0xe8, profile[19] = 0x03;
  const std::string text = profile_text(profile);
  EXPECT_EQ(text.substr(0, 21), "bno055 1 ecffa500e8ff");
  EXPECT_EQ(read_profile(text), profile);
  EXPECT_EQ(read_profile(text.substr(0, text.size() - 1)), profile) << "without the line's end";
}

TEST(Bno055Profile, RefusesWhatIsCutOrFlipped) {
  const std::string text = profile_text({1, 2, 3, 4});
  for (std::size_t n = 0; n + 1 < text.size(); ++n) EXPECT_FALSE(read_profile(text.substr(0, n))) << n;
  for (std::size_t bit = 0; bit + 8 < 8 * text.size(); ++bit) {
    std::string flipped = text;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    const auto read = read_profile(flipped);
    EXPECT_TRUE(!read || profile_text(*read) == text) << bit << ": a capital letter at most";
  }
  EXPECT_FALSE(read_profile(text + "x"));
}

TEST(Bno055Profile, RefusesWhatNoChipFinds) {
  Profile profile{};
  EXPECT_TRUE(is_possible(profile));
  profile[0] = 0xff, profile[1] = 0x7f;
  EXPECT_FALSE(is_possible(profile)) << "an offset of 32 g";
  EXPECT_FALSE(read_profile(profile_text(profile)));
}

TEST(Bno055MotionCheck, BelievesARobotThatTurns) {
  MotionCheck check;
  double yaw = 0, rate = 0;
  for (int i = 0; i < 300; ++i) {
    rate = 8 * std::sin(i * 0.05);  // up to 40 rad/s2
    yaw += rate * 0.01;
    EXPECT_EQ(check.check(Time(milliseconds(10 * i)), motion(yaw, rate)), Nonsense::kNone) << i;
  }
}

TEST(Bno055MotionCheck, FindsJumps) {
  MotionCheck check;
  EXPECT_EQ(check.check(Time(milliseconds(0)), motion(1)), Nonsense::kNone);
  EXPECT_EQ(check.check(Time(milliseconds(10)), motion(1.2)), Nonsense::kJump);
  EXPECT_EQ(check.check(Time(milliseconds(20)), motion(1, 30)), Nonsense::kRate);
  EXPECT_EQ(check.check(Time(milliseconds(30)), motion(1)), Nonsense::kNone);
}

TEST(Bno055MotionCheck, ForgetsWhatIsLongAgo) {
  MotionCheck check;
  check.check(Time(milliseconds(0)), motion(0));
  EXPECT_EQ(check.check(Time(milliseconds(400)), motion(2)), Nonsense::kNone);
  check.forget();
  EXPECT_EQ(check.check(Time(milliseconds(410)), motion(0)), Nonsense::kNone);
}

}  // namespace
}  // namespace dynslam::bno055
