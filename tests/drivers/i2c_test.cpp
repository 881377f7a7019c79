// SPDX-License-Identifier: MIT
#include <array>
#include <cerrno>
#include <deque>
#include <numeric>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/i2c/i2c_device.h"
#include "drivers/mock_i2c_bus.h"

namespace dynslam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

/// Remembers what is written to it; reads count up from the register that was named last. Fails as told.
class Memo : public test::I2cChip {
 public:
  int write(std::span<const std::uint8_t> bytes) override {
    if (const int error = next_fault()) return error;
    written.emplace_back(bytes.begin(), bytes.end());
    at_ = bytes[0];
    return 0;
  }
  int read(std::span<std::uint8_t> into) override {
    if (const int error = next_fault()) return error;
    std::iota(into.begin(), into.end(), at_);
    return 0;
  }

  std::vector<Bytes> written;
  std::deque<int> faults;  ///< for each of the next calls, 0 is none

 private:
  int next_fault() {
    if (faults.empty()) return 0;
    const int error = faults.front();
    faults.pop_front();
    return error;
  }
  std::uint8_t at_ = 0;
};

class I2cDeviceTest : public ::testing::Test {
 protected:
  I2cDeviceTest() {
    buses_.add_bus(1);
    buses_.plug(1, 0x28, &chip_);
  }
  test::MockI2cBuses buses_;
  Memo chip_;
  I2cDevice device_{"imu", "/dev/i2c-1", 0x28};
};

TEST_F(I2cDeviceTest, WritesACommandAloneAndWithItsArguments) {
  EXPECT_EQ(device_.write(0x0e), 0);
  EXPECT_EQ(device_.write(8, Bytes{128}), 0);
  EXPECT_EQ(device_.write(5, Bytes{1, 2, 3}), 0);
  EXPECT_THAT(chip_.written, ElementsAre(Bytes{14}, Bytes{8, 128}, Bytes{5, 1, 2, 3}));
}

TEST_F(I2cDeviceTest, ReadsAnyNumberOfRegisters) {
  for (const std::size_t n : {1U, 2U, 20U, 32U, 33U, 46U, 128U}) {
    Bytes read(n), expected(n);
    std::iota(expected.begin(), expected.end(), std::uint8_t{20});
    EXPECT_EQ(device_.read_registers(20, read), 0) << n;
    EXPECT_EQ(read, expected) << n;
  }
  EXPECT_EQ(buses_.long_transfers(), 3) << "only what is longer than 32 bytes";
}

TEST_F(I2cDeviceTest, AChipIsForOneAtATime) {
  Memo other_chip;
  buses_.plug(1, 0x15, &other_chip);
  I2cDevice second("second", "/dev/i2c-1", 0x28), other("other", "/dev/i2c-1", 0x15);
  {
    I2cDevice first("first", "/dev/i2c-1", 0x28);
    EXPECT_EQ(first.write(0x0e), 0);
    const int error = second.write(0x0e);
    EXPECT_NE(error, 0);
    EXPECT_THAT(second.failure(error).what(), HasSubstr("second: 0x28 on /dev/i2c-1 is in use"));
    EXPECT_EQ(other.write(0x0e), 0);
    EXPECT_EQ(first.write(0x0f), 0);
  }
  EXPECT_EQ(second.write(0x10), 0);
  EXPECT_THAT(chip_.written, ElementsAre(Bytes{0x0e}, Bytes{0x0f}, Bytes{0x10}));
}

TEST_F(I2cDeviceTest, AsksInTwoTransfers) {
  std::array<std::uint8_t, 6> answer{};
  EXPECT_EQ(device_.ask(21, answer), 0);
  EXPECT_THAT(answer, ElementsAre(21, 22, 23, 24, 25, 26));
  EXPECT_THAT(chip_.written, ElementsAre(Bytes{21}));
}

TEST_F(I2cDeviceTest, TriesAgainAfterAMissingAcknowledgement) {
  for (const int error : {EREMOTEIO, ENXIO, EIO, EAGAIN}) {
    chip_.faults = {error, error};
    EXPECT_EQ(device_.write(1), 0) << error;
  }
  EXPECT_EQ(device_.counters()["retries"], 8U);
  EXPECT_EQ(device_.counters()["nak"], 4U);
}

TEST_F(I2cDeviceTest, GivesUpAfterThreeTries) {
  chip_.faults = {EREMOTEIO, EREMOTEIO, EREMOTEIO, 0};
  EXPECT_EQ(device_.write(1), EREMOTEIO);
  EXPECT_EQ(device_.counters()["retries"], 2U);
  EXPECT_EQ(device_.write(1), 0);
}

TEST_F(I2cDeviceTest, DoesNotWaitAgainForABusThatHangs) {
  chip_.faults = {ETIMEDOUT};
  EXPECT_EQ(device_.write(1), ETIMEDOUT);
  EXPECT_EQ(device_.counters()["retries"], 0U);
  EXPECT_EQ(device_.counters()["timeouts"], 1U);
}

TEST_F(I2cDeviceTest, KnowsASoftwareBus) {
  EXPECT_EQ(device_.write(1), 0);
  EXPECT_FALSE(device_.is_software_bus());
  buses_.add_bus(3, true);
  buses_.plug(3, 0x28, &chip_);
  I2cDevice other{"imu", "/dev/i2c-3", 0x28};
  EXPECT_EQ(other.write(1), 0);
  EXPECT_TRUE(other.is_software_bus());
}

TEST_F(I2cDeviceTest, FindsABusThatAppearsLater) {
  I2cDevice late{"imu", "/dev/i2c-7", 0x28};
  EXPECT_EQ(late.write(1), ENOENT);
  buses_.add_bus(7);
  buses_.plug(7, 0x28, &chip_);
  EXPECT_EQ(late.write(1), 0);
}

TEST_F(I2cDeviceTest, TellsWhatToLookAt) {
  const auto text = [&](int error) { return std::string(device_.failure(error).what()); };
  EXPECT_THAT(text(ENOENT), HasSubstr("imu: no /dev/i2c-1"));
  EXPECT_THAT(text(EACCES), HasSubstr("group i2c"));
  EXPECT_EQ(text(EREMOTEIO),
            "imu: nothing answers at 0x28 on /dev/i2c-1: is it wired and powered, and this its address?");
  EXPECT_EQ(text(ENXIO), text(EREMOTEIO)) << "as i2c-gpio calls it";
  EXPECT_THAT(text(ETIMEDOUT), HasSubstr("hangs"));
}

TEST_F(I2cDeviceTest, NobodyElsesBytesComeBetweenAQuestionAndItsAnswer) {
  const auto ask_often = [&](std::uint8_t command) {
    for (int i = 0; i < 200; ++i) {
      std::array<std::uint8_t, 6> answer{};
      ASSERT_EQ(device_.ask(command, answer), 0);
      ASSERT_EQ(answer[0], command);
    }
  };
  std::thread other(ask_often, std::uint8_t{100});
  ask_often(50);
  other.join();
}

}  // namespace
}  // namespace dynslam
