// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "drivers/thunderborg/protocol.h"

namespace dynslam::thunderborg {
namespace {

constexpr Answer kBattery{0x15, 0x01, 0x54};  // 0x154 = 340; 340 * 36.3 / 1023 = 12.0645
constexpr Answer kReverse128{0x0a, 0x02, 0x80};
constexpr Answer kFailsafeOn{0x14, 0x01};

TEST(ThunderBorgProtocol, ReadsTheBattery) {
  EXPECT_NEAR(decode_battery_v(kBattery).value(), 12.0645, 1e-4);
  EXPECT_EQ(decode_battery_v({0x15, 0, 0}), 0.0);
  EXPECT_NEAR(decode_battery_v({0x15, 0x03, 0xff}).value(), 36.3, 1e-9);
  EXPECT_FALSE(decode_battery_v({0x15, 0x04, 0x00})) << "eleven bits";
  EXPECT_FALSE(decode_battery_v({0x15, 0xff, 0xff}));
}

TEST(ThunderBorgProtocol, ReadsAMotor) {
  EXPECT_EQ(decode_motor(kReverse128), -128);
  EXPECT_EQ(decode_motor({0x0a, 0x01, 0xff}), 255);
  EXPECT_EQ(decode_motor({0x0a, 0x02, 0x00}), 0);
  EXPECT_EQ(decode_motor({0x0a, 0x00, 0x00}), 0) << "before it was ever driven";
  EXPECT_FALSE(decode_motor({0x0a, 0x00, 0x01}));
  EXPECT_FALSE(decode_motor({0x0a, 0x03, 0x01}));
}

TEST(ThunderBorgProtocol, ReadsAFlag) {
  EXPECT_EQ(decode_flag(kFailsafeOn), true);
  EXPECT_EQ(decode_flag({0x14, 0}), false);
  for (int value = 2; value < 256; ++value)
    EXPECT_FALSE(decode_flag({0x14, static_cast<std::uint8_t>(value)})) << value;
}

TEST(ThunderBorgProtocol, MakesPowerOutOfShares) {
  EXPECT_EQ(motor_power(0.0), 0);
  EXPECT_EQ(motor_power(1.0), 255);
  EXPECT_EQ(motor_power(-1.0), -255);
  EXPECT_EQ(motor_power(0.5), 128) << "127.5";
  EXPECT_EQ(motor_power(1e300), 255);
  EXPECT_EQ(motor_power(-7), -255);
}

TEST(ThunderBorgProtocol, AFlippedBitInTheEchoIsNoticed) {
  for (int bit = 0; bit < 8; ++bit) {
    Answer answer = kBattery;
    answer[0] = static_cast<std::uint8_t>(answer[0] ^ 1 << bit);
    EXPECT_FALSE(belongs_to(answer, Command::kGetBattery)) << bit;
  }
  EXPECT_TRUE(belongs_to(kBattery, Command::kGetBattery));
}

TEST(ThunderBorgProtocol, AFlippedBitNeverGivesWhatCannotBe) {
  for (std::size_t byte = 1; byte < 6; ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      const auto flipped = [&](Answer answer) {
        answer[byte] = static_cast<std::uint8_t>(answer[byte] ^ 1 << bit);
        return answer;
      };
      const double volts = decode_battery_v(flipped(kBattery)).value_or(0);
      EXPECT_TRUE(volts >= 0 && volts <= 36.3) << volts;
      EXPECT_LE(std::abs(decode_motor(flipped(kReverse128)).value_or(0)), 255);
      if (byte > 2) {
        EXPECT_EQ(decode_motor(flipped(kReverse128)), -128) << "bytes that mean nothing";
      }
    }
  }
}

}  // namespace
}  // namespace dynslam::thunderborg
