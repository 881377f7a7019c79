// SPDX-License-Identifier: MIT
// The layer over libgpiod, whichever version it is, on an emulated chip.
#include <array>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/emulated_gpio_chip.h"
#include "drivers/gpio/chips.h"
#include "drivers/gpio/gpio_pins.h"
#include "drivers/gpio/output_pin.h"
#include "drivers/gpio/wheel_encoders.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

struct Unref {
  void operator()(UMockdevTestbed* bed) const { g_object_unref(bed); }
};

class GpioLines : public testing::Test {
 protected:
  void SetUp() override {
    if (umockdev_in_mock_environment() == 0) GTEST_SKIP() << "umockdev's preload library is not there";
  }

  /// What `f` complains of.
  template <class F>
  static std::string complaint(F&& f) {
    try {
      f();
    } catch (const DeviceError& e) {
      return e.what();
    }
    return "nothing";
  }

  static Clock::SteadyTime soon() { return std::chrono::steady_clock::now() + std::chrono::seconds(5); }

  std::unique_ptr<UMockdevTestbed, Unref> bed_{umockdev_testbed_new()};
  RunningClock clock_;
};

class GpioChip : public GpioLines {
 protected:
  EmulatedGpioChip chip_{bed_.get(), 0, "pinctrl-bcm2835", 54};
};

TEST_F(GpioLines, WithoutAChipSayThatThereIsNone) {
  EXPECT_TRUE(list_chips().empty());
  EXPECT_EQ(complaint([] { find_chip("auto", "pins"); }),
            "pins: there is no /dev/gpiochip*: has this computer any GPIO?");
}

TEST_F(GpioLines, TheHeadersChipIsFoundWhateverItsNumber) {
  const EmulatedGpioChip other(bed_.get(), 0, "raspberrypi-exp-gpio", 8);
  const EmulatedGpioChip header(bed_.get(), 4, "pinctrl-rp1", 54);
  const auto chips = list_chips();
  ASSERT_EQ(chips.size(), 2U);
  EXPECT_EQ(chips[0].label, "raspberrypi-exp-gpio");
  EXPECT_EQ(chips[0].lines, 8U);
  EXPECT_EQ(choose_chip(chips, "auto", "pins"), "/dev/gpiochip4");
  EXPECT_EQ(choose_chip(chips, "raspberrypi-exp-gpio", "pins"), "/dev/gpiochip0");
}

TEST_F(GpioChip, ReadsLevelsByHowTheyAreWired) {
  chip_.set_wire(17, true);
  chip_.set_wire(22, true);
  const std::array<LineUse, 3> uses = {{{17}, {22, true, Pull::kUp}, {23, true}}};
  const auto lines = open_inputs("/dev/gpiochip0", uses, "pins");
  std::array<bool, 3> active{};
  lines->read(active);
  EXPECT_THAT(active, testing::ElementsAre(true, false, true));
  EXPECT_TRUE(chip_.pulled_up(22));
  EXPECT_FALSE(chip_.pulled_up(17));
  EXPECT_EQ(chip_.consumer(22), "dynslam pins");
}

TEST_F(GpioChip, TellsEdgesInTheirOrderWithTheKernelsTime) {
  const std::array<LineUse, 2> uses = {{{17}, {22, true}}};
  const auto lines = open_inputs("/dev/gpiochip0", uses, "pins");
  const auto before = std::chrono::steady_clock::now();
  chip_.set_wire(22, true);
  chip_.set_wire(17, true);
  chip_.set_wire(22, false);
  std::array<LineEdge, 8> edges;
  ASSERT_EQ(lines->take_edges(edges, soon()), 3U);
  EXPECT_EQ(edges[0].index, 1U);
  EXPECT_FALSE(edges[0].active);
  EXPECT_EQ(edges[1].index, 0U);
  EXPECT_TRUE(edges[1].active);
  EXPECT_EQ(edges[2].index, 1U);
  EXPECT_TRUE(edges[2].active);
  EXPECT_GE(edges[0].at, before);
  EXPECT_LE(edges[2].at, std::chrono::steady_clock::now());
  EXPECT_EQ(lines->take_edges(edges, {}), 0U);
}

TEST_F(GpioChip, TakesNoMoreEdgesThanThereIsRoomFor) {
  const std::array<LineUse, 1> uses = {{{17}}};
  const auto lines = open_inputs("/dev/gpiochip0", uses, "pins");
  for (int i = 0; i < 6; ++i) chip_.set_wire(17, i % 2 == 0);
  std::array<LineEdge, 4> edges;
  std::size_t taken = 0;
  while (const std::size_t n = lines->take_edges(edges, {})) {
    ASSERT_LE(n, 4U);
    taken += n;
  }
  EXPECT_EQ(taken, 6U);
}

TEST_F(GpioChip, WaitsForAnEdgeButNoLongerThanAsked) {
  const std::array<LineUse, 1> uses = {{{17}}};
  const auto lines = open_inputs("/dev/gpiochip0", uses, "pins");
  std::array<LineEdge, 4> edges;
  const auto until = std::chrono::steady_clock::now() + milliseconds(30);
  EXPECT_EQ(lines->take_edges(edges, until), 0U);
  EXPECT_GE(std::chrono::steady_clock::now(), until);
  std::thread presses([this] { chip_.set_wire(17, true); });
  EXPECT_EQ(lines->take_edges(edges, soon()), 1U);
  presses.join();
}

TEST_F(GpioChip, ALineHasOneHolderAtATime) {
  const std::array<LineUse, 1> uses = {{{17}}};
  auto first = open_inputs("/dev/gpiochip0", uses, "pins");
  EXPECT_THAT(complaint([&] { open_inputs("/dev/gpiochip0", uses, "encoders"); }),
              HasSubstr("encoders: line 17 of /dev/gpiochip0: in use"));
  first.reset();
  EXPECT_EQ(chip_.consumer(17), std::nullopt);
  EXPECT_EQ(complaint([&] { open_inputs("/dev/gpiochip0", uses, "encoders"); }), "nothing");
}

TEST_F(GpioChip, NamesTheLineThatIsNotThere) {
  const std::array<LineUse, 1> uses = {{{99}}};
  EXPECT_THAT(complaint([&] { open_inputs("/dev/gpiochip0", uses, "pins"); }),
              HasSubstr("pins: line 99 of /dev/gpiochip0: the chip has no such line"));
}

TEST_F(GpioChip, NamesTheChipThatIsNotThere) {
  EXPECT_THAT(complaint([&] { open_output("/dev/gpiochip7", {1}, true, "status light"); }),
              HasSubstr("status light: /dev/gpiochip7: No such file"));
}

TEST_F(GpioChip, AFaultWhileReadingNamesTheLine) {
  const std::array<LineUse, 1> uses = {{{17}}};
  const auto lines = open_inputs("/dev/gpiochip0", uses, "pins");
  chip_.fail_with(EIO);
  std::array<bool, 1> active{};
  EXPECT_EQ(complaint([&] { lines->read(active); }), "pins: line 17 of /dev/gpiochip0: Input/output error");
}

TEST_F(GpioChip, AnOutputDrivesItsWireAndIsOffInTheEnd) {
  GpioConfig config;
  config.light_line = 5;
  config.light_active_low = true;
  auto light = make_status_light_pin(config);
  light->set(true);
  EXPECT_FALSE(chip_.wire(5));
  EXPECT_EQ(chip_.consumer(5), "dynslam status light");
  light->set(false);
  EXPECT_TRUE(chip_.wire(5));
  light->set(true);
  light.reset();
  EXPECT_TRUE(chip_.wire(5));
  EXPECT_EQ(make_lidar_motor_pin(config), nullptr);
}

TEST_F(GpioChip, AnOutputComesBackAfterAFault) {
  GpioConfig config;
  config.lidar_motor_line = 6;
  const auto motor = make_lidar_motor_pin(config);
  motor->set(true);
  chip_.fail_with(EIO);
  EXPECT_THAT(complaint([&] { motor->set(false); }), HasSubstr("lidar motor: line 6"));
  chip_.fail_with(0);
  motor->set(false);
  EXPECT_FALSE(chip_.wire(6));
}

TEST_F(GpioChip, PinsAreReadByLevelThoughAllEdgesAreLost) {
  GpioConfig config;
  config.estop_line = 17;
  config.bumper_lines = {"22", "27"};
  config.bumper_debounce_s = 0.001;
  GpioPins pins(config, clock_);
  EXPECT_FALSE(pins.read().estop_pressed);
  chip_.lose_edges(true);
  chip_.set_wire(17, true);
  chip_.set_wire(27, true);
  EXPECT_TRUE(pins.read().estop_pressed);
  std::this_thread::sleep_for(milliseconds(3));
  EXPECT_EQ(pins.read().bumper_pressed, true);
}

TEST_F(GpioChip, APressBetweenTwoReadingsIsTold) {
  GpioConfig config;
  config.estop_line = 17;
  GpioPins pins(config, clock_);
  EXPECT_FALSE(pins.read().estop_pressed);
  chip_.set_wire(17, true);
  chip_.set_wire(17, false);
  EXPECT_TRUE(pins.read().estop_pressed);
}

TEST_F(GpioChip, EncodersCountWhatTheWheelsRoll) {
  EncodersConfig config;
  config.left_a_line = 5, config.left_b_line = 6, config.right_a_line = 12, config.right_b_line = 13;
  config.metres_per_step = 0.01;
  WheelEncoders encoders(config, clock_);
  ASSERT_TRUE(encoders.next(clock_.now() + milliseconds(500)));
  // Two steps forward of each; the right one is mounted the other way round.
  for (const unsigned line : {5U, 13U, 6U, 12U}) chip_.set_wire(line, true);
  const auto moved = encoders.next(clock_.now() + milliseconds(500));
  ASSERT_TRUE(moved);
  EXPECT_NEAR(moved->odom_T_robot.x, 0.02, 1e-12);
  EXPECT_NEAR(moved->odom_T_robot.yaw, 0.0, 1e-12);
  EXPECT_TRUE(encoders.counters().empty());
}

}  // namespace
}  // namespace dynslam
