// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/emulated_hardware.h"
#include "drivers/thunderborg/thunderborg.h"
#include "probe_command.h"
#include "sim/small_world.h"

namespace dynslam::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

struct Said {
  int exit_code;
  std::string text;
};

Said probe(const EmulatedHardware& hardware, const std::string& answer = "", bool spins = false) {
  std::istringstream in(answer);
  std::ostringstream out;
  const int code = run_probe({spins}, hardware.config(), in, out);
  return {code, out.str()};
}

/// The lines of the picture, without its frame.
std::vector<std::string> picture_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("  |") && line.ends_with("|")) lines.push_back(line.substr(3, line.size() - 4));
  return lines;
}

TEST(Probe, TellsWhatEachDeviceIsAndSays) {
  EmulatedHardware hardware(bare_room());
  const auto [code, text] = probe(hardware);
  EXPECT_EQ(code, 0) << text;
  EXPECT_THAT(text, ContainsRegex("^lidar    A3M1, firmware 1.29, hardware 7, on /.* at 256000 baud\n"));
  EXPECT_THAT(text, HasSubstr("\n         * mode Sensitivity: 15898 beams a second, up to 25 m\n"));
  EXPECT_THAT(text, ContainsRegex("\n         a turn has 1[56][0-9][0-9] beams, 1[45][0-9][0-9] of them"));
  EXPECT_THAT(text, HasSubstr("\nimu      BNO055, software 3.11, on /dev/i2c-3 (a bus by software"));
  EXPECT_THAT(text, ContainsRegex("\n         heading -?[0-9]+\\.[0-9] degrees, 25 degrees warm\n"));
  EXPECT_THAT(text, HasSubstr("\n         calibrated (0 to 3): gyroscope 0, accelerometer 0, compass 0\n"));
  EXPECT_THAT(text, HasSubstr("\nmotors   ThunderBorg on /dev/i2c-1, battery 12.5 V, failsafe on\n"));
  EXPECT_THAT(text, HasSubstr("\ncamera   none, says camera.name\n"));
  EXPECT_THAT(text, HasSubstr("\npins     e-stop released, no bumper pressed\n"));
  EXPECT_THAT(text, HasSubstr("\ncomputer not a Raspberry Pi\n"));
}

TEST(Probe, LeavesTheDevicesOfARobotThatRunsAlone) {
  EmulatedHardware hardware(bare_room());
  ThunderBorg board(hardware.config().hardware.motors, hardware.clock);
  board.drive({0.5, 0.5});
  std::atomic<bool> switched_off{false};
  hardware.motors.on_driven([&](double a, double) { switched_off = switched_off || a == 0.0; });
  const auto [code, text] = probe(hardware);
  EXPECT_EQ(code, 1);
  EXPECT_THAT(
      text, HasSubstr("\nmotors   does not answer. motors: 0x15 on /dev/i2c-1 is in use: does dynslam run"));
  EXPECT_FALSE(switched_off) << "the motors were switched off";
}

TEST(Probe, DrawsWhatTheLidarSeesWithTheRobotsFrontUp) {
  EmulatedHardware hardware(bare_room());  // a wall 2 m behind, 3 m to both sides, 6 m ahead
  const auto picture = picture_of(probe(hardware).text);
  ASSERT_EQ(picture.size(), 21U);
  const std::size_t middle = picture[10].find('^');
  EXPECT_EQ(middle, 21U);
  const auto walls = [&](int row) {
    return std::count(picture[static_cast<std::size_t>(row)].begin(),
                      picture[static_cast<std::size_t>(row)].end(), '#');
  };
  EXPECT_EQ(walls(0), 2) << "the sides";
  EXPECT_GT(walls(15), 25) << "the wall behind";
  EXPECT_EQ(walls(20), 0);
}

TEST(Probe, SaysWhatToDoWhenNothingIsThere) {
  EmulatedHardware hardware(bare_room(), EmulatedHardware::Plugged::kNothing);
  const auto [code, text] = probe(hardware);
  EXPECT_EQ(code, 1);
  EXPECT_THAT(text, ContainsRegex("^lidar    does not answer. lidar: .*is it plugged in"));
  EXPECT_THAT(text,
              HasSubstr("\nimu      does not answer. imu: no /dev/i2c-3: is it switched on in config.txt"));
  EXPECT_THAT(text, HasSubstr("\nmotors   does not answer. motors: no /dev/i2c-1: is it switched on"));
  EXPECT_THAT(text, HasSubstr("\npins     does not answer. pins: there is no /dev/gpiochip*"));
}

class ProbeSpins : public ::testing::Test {
 protected:
  ProbeSpins() {
    hardware_.motors.on_driven([this](double a, double b) {
      forwards_ = forwards_ || (a > 0.0 && b > 0.0);
      backwards_ = backwards_ || (a < 0.0 && b < 0.0);
      strongest_ = std::max({strongest_, std::abs(a), std::abs(b)});
    });
  }

  EmulatedHardware hardware_{bare_room()};
  bool forwards_ = false, backwards_ = false;
  double strongest_ = 0.0;
};

TEST_F(ProbeSpins, TheMotorsOnlyAfterAYes) {
  for (const char* answer : {"", "no\n", "y\n", "yes please\n"}) {
    const auto [code, text] = probe(hardware_, answer, true);
    EXPECT_EQ(code, 0);
    EXPECT_THAT(text, HasSubstr("Lift the robot, and answer yes: "));
    EXPECT_THAT(text, HasSubstr("the wheels were left alone"));
    EXPECT_EQ(strongest_, 0.0) << answer;
  }
  EXPECT_THAT(probe(hardware_, "yes\n").text, Not(HasSubstr("Lift the robot"))) << "nobody asked for it";
  EXPECT_EQ(strongest_, 0.0);
}

TEST_F(ProbeSpins, TheMotorsForthAndBackSlowly) {
  const auto [code, text] = probe(hardware_, "yes\n", true);
  EXPECT_EQ(code, 0);
  EXPECT_TRUE(forwards_ && backwards_) << text;
  EXPECT_NEAR(strongest_, 0.25, 0.01);
  EXPECT_THAT(text, HasSubstr("did both wheels turn forwards first?"));
  EXPECT_EQ(hardware_.motors.power_a(), 0.0);
  EXPECT_EQ(hardware_.motors.power_b(), 0.0);
}

}  // namespace
}  // namespace dynslam::test
