// SPDX-License-Identifier: MIT
#include "drivers/thunderborg/thunderborg.h"

#include <array>
#include <cerrno>
#include <limits>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/mock_i2c_bus.h"
#include "drivers/thunderborg_emulator.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using test::ChipFaults;
using test::Garble;
using ::testing::HasSubstr;

class ThunderBorgTest : public ::testing::Test {
 protected:
  ThunderBorgTest() {
    buses_.add_bus(1);
    buses_.plug(1, 0x15, &board_);
  }

  ThunderBorg& motors() {
    if (!motors_) motors_ = std::make_unique<ThunderBorg>(config_, clock_);
    return *motors_;
  }
  void pass(milliseconds time) { clock_.set(clock_.now() + time); }
  std::string trouble(const WheelPower& power = {0.5, 0.5}) {
    try {
      motors().drive(power);
    } catch (const DeviceError& e) {
      return e.what();
    }
    return {};
  }
  std::uint64_t count(const char* what) { return motors().counters()[what]; }
  void expect_power(double a, double b) {
    EXPECT_NEAR(board_.power_a(), a, 0.5 / 255);
    EXPECT_NEAR(board_.power_b(), b, 0.5 / 255);
  }

  SteppedClock clock_{time_at_s(5)};
  test::ThunderBorgEmulator board_{[this] { return clock_.now(); }};
  test::MockI2cBuses buses_;
  ThunderBorgConfig config_;
  std::unique_ptr<ThunderBorg> motors_;
};

TEST_F(ThunderBorgTest, DrivesBothSides) {
  for (const WheelPower& p : {WheelPower{0.5, -0.25}, {1, 1}, {-1, 0}, {0, 0}, {0.001, 0.1}}) {
    motors().drive(p);
    expect_power(p.left, p.right);
  }
  motors().drive({3, -9});
  expect_power(1, -1);
}

TEST_F(ThunderBorgTest, IsWiredAsTheConfigSays) {
  config_.swap = true;
  config_.invert_a = true;
  board_.set_motor_faults(true, false);
  motors().drive({0.5, 0.25});
  expect_power(-0.25, 0.5);
  const MotorState state = motors().read();
  EXPECT_TRUE(state.right_fault);
  EXPECT_FALSE(state.left_fault);
}

TEST_F(ThunderBorgTest, ReadsBatteryAndFaults) {
  board_.set_battery_v(11.25);
  EXPECT_NEAR(motors().read().battery_v, 11.25, 0.02);
  EXPECT_TRUE(motors().read().failsafe_on);
  board_.set_motor_faults(true, true);
  for (int i = 0; i < 3; ++i) motors().read();
  EXPECT_TRUE(motors().read().left_fault);
  EXPECT_TRUE(motors().read().right_fault);
  board_.set_motor_faults(false, true);
  for (int i = 0; i < 3; ++i) motors().read();
  EXPECT_FALSE(motors().read().left_fault);
}

TEST_F(ThunderBorgTest, SwitchesTheFailsafeOnBeforeAnythingMoves) {
  motors();
  EXPECT_TRUE(board_.failsafe_on());
  motors().drive({1, 1});
  pass(milliseconds(240));
  expect_power(1, 1);
  pass(milliseconds(20));
  expect_power(0, 0);
  EXPECT_EQ(trouble({0.5, 0.5}), "") << "that the failsafe struck in between is no fault of the board";
  expect_power(0.5, 0.5);
}

TEST_F(ThunderBorgTest, DoesNotDriveABoardWithoutFailsafe) {
  board_.refuse_failsafe(true);
  EXPECT_THAT(trouble(), HasSubstr("failsafe cannot be switched on"));
  expect_power(0, 0);
}

TEST_F(ThunderBorgTest, SetsUpABoardThatLostItsPowerForAMoment) {
  motors().set_light({1, 2, 3});
  motors().drive({1, 1});
  for (int i = 0; i < 3; ++i) motors().read();
  board_.reset();
  EXPECT_FALSE(board_.failsafe_on());
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(motors().read().failsafe_on);
  EXPECT_TRUE(board_.failsafe_on());
  EXPECT_EQ(count("failsafe-off"), 1U);
  motors().read();
  EXPECT_EQ(board_.lights(), (std::array{1, 2, 3}));
}

TEST_F(ThunderBorgTest, SaysAgainWhatTheBoardForgot) {
  motors();
  board_.forget_commands(1);
  motors().drive({0.5, 0.5});
  expect_power(0.5, 0.5);
  EXPECT_EQ(count("readback"), 1U);
}

TEST_F(ThunderBorgTest, NoticesTheForgottenCommandOfEitherMotorInTwoTicks) {
  motors().drive({0.5, 0.5});  // looked at A
  motors().drive({0.5, 0.5});
  board_.forget_commands(2);
  motors().drive({1, 1});
  motors().drive({1, 1});
  expect_power(1, 1);
}

TEST_F(ThunderBorgTest, SwitchesOffWhatDoesNotObey) {
  motors().drive({1, 1});
  board_.forget_commands(ChipFaults::kForever);
  EXPECT_THAT(trouble({0.2, 0.2}), HasSubstr("does not do what it is told"));
  expect_power(0, 0);
  EXPECT_EQ(count("distrusted"), 1U);
}

TEST_F(ThunderBorgTest, PutsUpWithSomeMissingAcknowledgements) {
  motors();
  for (const int error : {EREMOTEIO, ENXIO, EIO}) {
    board_.fail(error, 2);
    EXPECT_EQ(trouble(), "") << error;
    expect_power(0.5, 0.5);
  }
  EXPECT_EQ(count("retries"), 6U);
}

TEST_F(ThunderBorgTest, PutsUpWithSomeGarbledAnswers) {
  motors();
  for (const Garble how : {Garble::kZeros, Garble::kOnes, Garble::kSwapped, Garble::kTopBit}) {
    board_.garble(how, 2);
    EXPECT_NEAR(motors().read().battery_v, 12.5, 0.02) << static_cast<int>(how);
  }
  EXPECT_GE(count("wrong-answer"), 4U);
}

TEST_F(ThunderBorgTest, SwitchesOffAfterTooManyGarbledAnswers) {
  for (const Garble how : {Garble::kZeros, Garble::kOnes, Garble::kSwapped, Garble::kTopBit}) {
    motors().drive({1, 1});
    board_.garble(how, ChipFaults::kForever);
    EXPECT_THROW(motors().read(), DeviceError);
    expect_power(0, 0);
    board_.garble(how, 0);
    pass(milliseconds(200));
  }
}

TEST_F(ThunderBorgTest, NeedNotBeThereAtTheStart) {
  buses_.plug(1, 0x15, nullptr);
  EXPECT_THAT(trouble(), HasSubstr("nothing answers at 0x15"));
  buses_.plug(1, 0x15, &board_);
  EXPECT_THAT(trouble(), HasSubstr("nothing answers")) << "not asked again so soon";
  pass(milliseconds(200));
  EXPECT_EQ(trouble(), "");
  expect_power(0.5, 0.5);
}

TEST_F(ThunderBorgTest, ComesBackAfterItWasPulled) {
  motors().drive({1, 1});
  buses_.plug(1, 0x15, nullptr);
  EXPECT_THROW(motors().drive({1, 1}), DeviceError);
  EXPECT_THROW(motors().read(), DeviceError);
  board_.reset();
  buses_.plug(1, 0x15, &board_);
  pass(milliseconds(200));
  EXPECT_TRUE(motors().read().failsafe_on);
  expect_power(0, 0);
  motors().drive({0.5, 0.5});
  expect_power(0.5, 0.5);
}

TEST_F(ThunderBorgTest, DoesNotHoldUpTheRobotForABusThatHangs) {
  motors();
  board_.fail(ETIMEDOUT, ChipFaults::kForever);
  EXPECT_THAT(trouble(), HasSubstr("hangs"));
  const int before = board_.transfers();
  for (int i = 0; i < 10; ++i) EXPECT_THAT(trouble(), HasSubstr("hangs"));
  EXPECT_EQ(board_.transfers(), before);
  pass(milliseconds(200));
  EXPECT_THAT(trouble(), HasSubstr("hangs"));
  EXPECT_LE(board_.transfers(), before + 2) << "it is asked once, and told once to switch off";
}

TEST_F(ThunderBorgTest, RefusesWhatIsNoThunderBorg) {
  board_.set_identity(0x28);
  EXPECT_THAT(trouble(), HasSubstr("no ThunderBorg"));
}

TEST_F(ThunderBorgTest, SwitchesOffWhenToldNonsense) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  motors().drive({1, 1});
  EXPECT_THAT(trouble({kNan, 0.5}), HasSubstr("no number"));
  expect_power(0, 0);
}

TEST_F(ThunderBorgTest, SwitchesOffInTheEnd) {
  motors().set_light({9, 9, 9});
  motors().drive({1, 1});
  motors().read();
  motors_.reset();
  expect_power(0, 0);
  EXPECT_FALSE(board_.lights()) << "they show the battery again";
}

TEST_F(ThunderBorgTest, SwitchesOffWhatAnEarlierRunLeftRunning) {
  {
    I2cDevice crashed("crashed", config_.bus, config_.address);
    for (const auto command : {thunderborg::Command::kForwardA, thunderborg::Command::kForwardB})
      EXPECT_EQ(crashed.write(static_cast<std::uint8_t>(command), std::array<std::uint8_t, 1>{255}), 0);
  }
  expect_power(1, 1);
  motors();
  expect_power(0, 0);
}

TEST_F(ThunderBorgTest, ShowsAColor) {
  motors().read();
  EXPECT_FALSE(board_.lights()) << "the battery, until told otherwise";
  motors().set_light({255, 128, 1});
  motors().read();
  EXPECT_EQ(board_.lights(), (std::array{255, 128, 1}));
  const int before = board_.transfers();
  motors().read();
  EXPECT_EQ(board_.transfers(), before + 4) << "told once, not every time";
}

TEST_F(ThunderBorgTest, ShowsHowFarTheRobotMayMove) {
  motors().show(Motion::kGo);
  motors().read();
  EXPECT_EQ(board_.lights(), (std::array{0, 80, 0}));
  motors().show(Motion::kEStop);
  motors().read();
  EXPECT_EQ(board_.lights(), (std::array{80, 0, 80}));
}

TEST_F(ThunderBorgTest, ReportsAllItKnows) {
  board_.set_battery_v(10);
  board_.set_motor_faults(false, true);
  motors().drive({-0.5, 1});
  const ThunderBorgReport report = motors().report();
  EXPECT_NEAR(report.battery_v, 10, 0.02);
  EXPECT_TRUE(report.failsafe_on);
  EXPECT_FALSE(report.fault_a);
  EXPECT_TRUE(report.fault_b);
  EXPECT_EQ(report.power_a, -128);
  EXPECT_EQ(report.power_b, 255);
}

}  // namespace
}  // namespace dynslam
