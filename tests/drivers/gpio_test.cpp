// SPDX-License-Identifier: MIT
// What needs no chip: contacts, encoders, lights, the choice of a chip, and pins on lines that are made up.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/gpio/chips.h"
#include "drivers/gpio/debounce.h"
#include "drivers/gpio/gpio_pins.h"
#include "drivers/gpio/output_pin.h"
#include "drivers/gpio/status_light.h"
#include "drivers/gpio/wheel_encoders.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

Time at_ms(std::int64_t ms) { return Time(milliseconds(ms)); }

template <class F>
std::string complaint(F&& f) {
  try {
    f();
  } catch (const DeviceError& e) {
    return e.what();
  }
  return "nothing";
}

/// One character a millisecond, '#' is pressed; what comes out.
std::string debounced(Debounce contact, const std::string& levels) {
  std::string out;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    contact.update(at_ms(static_cast<std::int64_t>(i)), levels[i] == '#');
    out += contact.on() ? '#' : '.';
  }
  return out;
}

TEST(Debounce, WaitsUntilTheContactIsStillBothWays) {
  EXPECT_EQ(debounced({milliseconds(5), milliseconds(5)}, "....#.#.##########.#.#........"),
            /*                                         */ ".............##############...");
}

TEST(Debounce, TakesNoNoticeOfASpike) {
  EXPECT_EQ(debounced({milliseconds(5), milliseconds(5)}, "....####....##...####........"),
            /*                                         */ ".............................");
}

TEST(Debounce, BelievesTheFirstEdgeWhenItShould) {
  EXPECT_EQ(debounced({Duration(0), milliseconds(8)}, "....#..........#....#.........."),
            /*                                     */ "....#########..##############..");
}

TEST(Debounce, BelievesTheFirstLevel) {
  EXPECT_EQ(debounced({milliseconds(5), milliseconds(5)}, "###......."), "########..");
  EXPECT_EQ(debounced({milliseconds(5), milliseconds(5)}, "..."), "...");
}

TEST(Debounce, TellsOfAPressThatIsOverAlready) {
  Debounce contact(milliseconds(5), milliseconds(5));
  contact.update(at_ms(0), false);
  contact.update(at_ms(10), true);
  contact.update(at_ms(18), false);
  contact.update(at_ms(40), false);
  EXPECT_FALSE(contact.on());
  EXPECT_TRUE(contact.was_on());
  EXPECT_FALSE(contact.was_on());
}

TEST(Debounce, StampsThatRunBackwardsCountAsTheLast) {
  Debounce contact(milliseconds(5), milliseconds(5));
  contact.update(at_ms(100), false);
  contact.update(at_ms(50), true);
  contact.update(at_ms(104), true);
  EXPECT_FALSE(contact.on());
  contact.update(at_ms(105), true);
  EXPECT_TRUE(contact.on());
}

/// The channels' waves, '#' is high.
Quadrature counted(const std::string& a, const std::string& b) {
  Quadrature counter;
  for (std::size_t i = 0; i < a.size(); ++i) counter.see(a[i] == '#', b[i] == '#');
  return counter;
}

TEST(Quadrature, CountsFourStepsAPeriodForwardWhenALeads) {
  const Quadrature forward = counted("..####....####..",  //
                                     "....####....####");
  EXPECT_EQ(forward.count(), 7);
  EXPECT_EQ(forward.illegal(), 0U);
  EXPECT_EQ(counted("....####....####",  //
                    "..####....####..")
                .count(),
            -7);
}

TEST(Quadrature, TremblingAtAnEdgeCountsNothing) {
  const Quadrature counter = counted("..#.#.#.#.",  //
                                     "..........");
  EXPECT_EQ(counter.count(), 0);
  EXPECT_EQ(counter.illegal(), 0U);
}

TEST(Quadrature, BothChannelsAtOnceIsIllegalWhateverTheState) {
  for (const bool a : {false, true}) {
    for (const bool b : {false, true}) {
      Quadrature counter;
      counter.see(a, b);
      EXPECT_EQ(counter.see(!a, !b), 0);
      EXPECT_EQ(counter.illegal(), 1U);
    }
  }
}

TEST(Quadrature, AnEdgeToWhatIsThereWasLost) {
  Quadrature counter;
  counter.see(false, false);
  EXPECT_EQ(counter.edge(true, true), 1);
  EXPECT_EQ(counter.edge(true, true), 0);
  EXPECT_EQ(counter.illegal(), 1U);
  EXPECT_EQ(counter.edge(false, true), 1);
  EXPECT_EQ(counter.count(), 2);
}

TEST(WheelOdometry, RollsStraightAndAroundAQuarter) {
  WheelOdometry straight(0.3);
  straight.roll(1.0, 1.0);
  EXPECT_EQ(straight.odom_T_robot(), (Pose2{1.0, 0.0, 0.0}));
  // A quarter to the left around a point 1 m to the left: the sides roll 0.85 and 1.15 m times pi / 2.
  WheelOdometry quarter(0.3);
  quarter.roll(0.85 * M_PI_2, 1.15 * M_PI_2);
  EXPECT_NEAR(quarter.odom_T_robot().x, 1.0, 1e-12);
  EXPECT_NEAR(quarter.odom_T_robot().y, 1.0, 1e-12);
  EXPECT_NEAR(quarter.odom_T_robot().yaw, M_PI_2, 1e-12);
}

TEST(WheelOdometry, TurnsOnTheSpotByTheTrack) {
  WheelOdometry odometry(0.3);
  odometry.roll(-0.15, 0.15);
  EXPECT_NEAR(odometry.odom_T_robot().yaw, 1.0, 1e-12);
  EXPECT_NEAR(std::hypot(odometry.odom_T_robot().x, odometry.odom_T_robot().y), 0.0, 1e-12);
}

/// A second of the light, a character every 25 ms.
std::string second_of_light(Motion motion) {
  std::string text;
  for (int ms = 0; ms < 1000; ms += 25) text += status_light(motion, at_ms(ms)) ? '#' : '.';
  return text;
}

TEST(StatusLight, SaysHowFarTheRobotMayMove) {
  EXPECT_EQ(second_of_light(Motion::kGo), "########################################");
  EXPECT_EQ(second_of_light(Motion::kSlow), "################################........");
  EXPECT_EQ(second_of_light(Motion::kHold), "################################........");
  EXPECT_EQ(second_of_light(Motion::kStop), "####################....................");
  EXPECT_EQ(second_of_light(Motion::kEStop), "#####.....#####.....#####.....#####.....");
}

TEST(StatusLight, BlinksBeforeTheClocksEpochToo) {
  EXPECT_FALSE(status_light(Motion::kStop, at_ms(-100)));
  EXPECT_TRUE(status_light(Motion::kStop, at_ms(-600)));
}

TEST(ChooseChip, ByPathNameAndLabel) {
  const std::vector<ChipInfo> chips = {{"/dev/gpiochip0", "pinctrl-bcm2711", 58},
                                       {"/dev/gpiochip1", "usb-thing", 4}};
  EXPECT_EQ(choose_chip(chips, "auto", "pins"), "/dev/gpiochip0");
  for (const char* name : {"/dev/gpiochip1", "gpiochip1", "usb-thing"})
    EXPECT_EQ(choose_chip(chips, name, "pins"), "/dev/gpiochip1") << name;
}

TEST(ChooseChip, SaysWhatThereIsWhenTheOneIsNot) {
  const std::vector<ChipInfo> chips = {{"/dev/gpiochip0", "other", 8}, {"/dev/gpiochip1", "third", 8}};
  EXPECT_EQ(
      complaint([&] { choose_chip(chips, "pinctrl-rp1", "pins"); }),
      "pins: no chip is called 'pinctrl-rp1': set gpio.chip to one of gpiochip0 (other), gpiochip1 (third)");
  EXPECT_THAT(complaint([&] { choose_chip(chips, "auto", "pins"); }), HasSubstr("Raspberry Pi's header"));
}

TEST(ChooseChip, WithoutPermissionPointsAtTheGroup) {
  const std::vector<ChipInfo> chips = {{"/dev/gpiochip0", "", 0, EACCES}};
  EXPECT_EQ(complaint([&] { choose_chip(chips, "auto", "pins"); }),
            "pins: /dev/gpiochip0: Permission denied: is the user in group gpio?");
}

/// Lines whose levels and edges a test sets.
struct MadeUp {
  std::vector<bool> levels;
  std::vector<LineEdge> edges;
  std::vector<LineUse> uses;
  std::string trouble;
  int opened = 0;
};

class MadeUpLines : public InputLines {
 public:
  explicit MadeUpLines(MadeUp& world) : world_(world) {}
  void read(std::span<bool> active) override {
    if (!world_.trouble.empty()) throw DeviceError(world_.trouble);
    for (std::size_t i = 0; i < active.size(); ++i) active[i] = world_.levels.at(i);
  }
  std::size_t take_edges(std::span<LineEdge> edges, Clock::SteadyTime) override {
    const std::size_t n = std::min(edges.size(), world_.edges.size());
    std::copy_n(world_.edges.begin(), n, edges.begin());
    world_.edges.erase(world_.edges.begin(), world_.edges.begin() + static_cast<std::ptrdiff_t>(n));
    return n;
  }

 private:
  MadeUp& world_;
};

class Pins3 : public testing::Test {
 protected:
  Pins3() {
    config_.estop_line = 17;
    config_.bumper_lines = {"22", "27"};
  }
  GpioPins make_pins() {
    return GpioPins(config_, clock_, [this](std::span<const LineUse> uses) {
      if (!world_.trouble.empty()) throw DeviceError(world_.trouble);
      world_.uses.assign(uses.begin(), uses.end());
      ++world_.opened;
      return std::make_unique<MadeUpLines>(world_);
    });
  }
  void pass(Duration d) { clock_.set(clock_.now() + d); }

  GpioConfig config_;
  SteppedClock clock_;
  MadeUp world_{{false, false, false}, {}, {}, {}};
};

TEST_F(Pins3, AskForTheConfiguredLinesWiredAsConfigured) {
  config_.bumper_active_low = true;
  make_pins().read();
  ASSERT_EQ(world_.uses.size(), 3U);
  EXPECT_EQ(world_.uses[0].offset, 17U);
  EXPECT_FALSE(world_.uses[0].active_low);
  EXPECT_EQ(world_.uses[2].offset, 27U);
  EXPECT_TRUE(world_.uses[2].active_low);
  EXPECT_EQ(world_.uses[2].pull, Pull::kUp);
}

TEST_F(Pins3, TheEStopCountsAtOnceAndIsReleasedAfter50ms) {
  GpioPins pins = make_pins();
  EXPECT_FALSE(pins.read().estop_pressed);
  world_.levels[0] = true;
  EXPECT_TRUE(pins.read().estop_pressed);
  world_.levels[0] = false;
  pins.read();
  pass(milliseconds(49));
  EXPECT_TRUE(pins.read().estop_pressed);
  pass(milliseconds(1));
  pins.read();
  EXPECT_FALSE(pins.read().estop_pressed);
}

TEST_F(Pins3, ABumperHasToBePressedForAWhile) {
  GpioPins pins = make_pins();
  EXPECT_EQ(pins.read().bumper_pressed, false);
  world_.levels[2] = true;
  EXPECT_EQ(pins.read().bumper_pressed, false);
  pass(milliseconds(5));
  EXPECT_EQ(pins.read().bumper_pressed, true);
  EXPECT_FALSE(pins.read().estop_pressed);
}

TEST_F(Pins3, AnEdgeFromAnotherClockCountsAsNow) {
  GpioPins pins = make_pins();
  pins.read();
  const auto ages_ago = std::chrono::steady_clock::now() - std::chrono::hours(1000);
  world_.edges = {{0, true, ages_ago}, {0, false, ages_ago}};
  EXPECT_TRUE(pins.read().estop_pressed);
}

TEST_F(Pins3, WithoutBumpersSayNothingOfThem) {
  config_.bumper_lines.clear();
  EXPECT_EQ(make_pins().read().bumper_pressed, std::nullopt);
}

TEST_F(Pins3, WithoutAnEStopTheFirstLineIsABumper) {
  config_.estop_line = -1;
  world_.levels[0] = true;
  const PinState state = make_pins().read();
  EXPECT_FALSE(state.estop_pressed);
  EXPECT_EQ(state.bumper_pressed, true);
}

TEST_F(Pins3, ComeBackByThemselvesHalfASecondAfterAFault) {
  GpioPins pins = make_pins();
  pins.read();
  world_.trouble = "pins: gone";
  EXPECT_EQ(complaint([&] { pins.read(); }), "pins: gone");
  world_.trouble.clear();
  EXPECT_EQ(complaint([&] { pins.read(); }), "pins: gone") << "not asked again so soon";
  pass(milliseconds(500));
  world_.levels[0] = true;
  EXPECT_TRUE(pins.read().estop_pressed);
  EXPECT_EQ(world_.opened, 2);
}

TEST(GpioConfig, NoLineIsUsedTwice) {
  GpioConfig config;
  EXPECT_EQ(config.problem(), std::nullopt);
  EXPECT_FALSE(config.has_pins());
  config.estop_line = 17;
  config.bumper_lines = {"22", "17"};
  EXPECT_EQ(config.problem(), "gpio: line 17 is used twice");
}

TEST(GpioConfig, LinesAreNumbers) {
  GpioConfig config;
  for (const char* text : {"", "GPIO22", "22 ", "-1", "512", "99999999999999"}) {
    config.bumper_lines = {text};
    EXPECT_THAT(config.problem().value_or(""), HasSubstr("is no number")) << text;
  }
  config.bumper_lines = {"0", "511"};
  EXPECT_EQ(config.problem(), std::nullopt);
  config.pull = "sideways";
  EXPECT_EQ(config.problem(), "gpio.pull: not 'up', 'down' or 'none'");
}

TEST(GpioConfig, KnowsItsLines) {
  GpioConfig config;
  config.estop_line = 17;
  config.bumper_lines = {"27", "22"};
  for (const int line : {17, 22, 27}) EXPECT_TRUE(config.uses(line)) << line;
  for (const int line : {-1, 0, 5}) EXPECT_FALSE(config.uses(line)) << line;
}

TEST(EncodersConfig, HasAllFourLinesOrNone) {
  EncodersConfig config;
  EXPECT_EQ(config.problem(), std::nullopt);
  EXPECT_FALSE(config.has_encoders());
  config.left_a_line = 5;
  EXPECT_TRUE(config.problem());
  config.left_b_line = 6, config.right_a_line = 12, config.right_b_line = 12;
  EXPECT_EQ(config.problem(), "encoders: a line is used twice");
  config.right_b_line = 13;
  EXPECT_EQ(config.problem(), std::nullopt);
  EXPECT_TRUE(config.has_encoders());
}

TEST(OutputPin, IsOpenedAtTheFirstUseAndSetOnlyWhenItChanges) {
  struct Wire : OutputLine {
    explicit Wire(std::string& log) : log_(log) {}
    void set(bool active) override { log_ += active ? '1' : '0'; }
    std::string& log_;
  };
  std::string log;
  {
    OutputPin pin([&](bool active) {
      log += active ? "open1 " : "open0 ";
      return std::make_unique<Wire>(log);
    });
    for (const bool on : {true, true, false, false, true}) pin.set(on);
  }
  EXPECT_EQ(log, "open1 010");
}

}  // namespace
}  // namespace dynslam
