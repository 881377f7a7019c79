// SPDX-License-Identifier: MIT
#include "drive/drive_control.h"

#include <algorithm>
#include <random>
#include <string>

#include <gmock/gmock.h>

#include "drive/good_inputs.h"

namespace dynslam {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Twist kStand{0, 0};
constexpr Twist kForward{0.6, 0};

/// A healthy robot with a driver who sends every 50 ms and a control thread that ticks every 20.
struct Drive {
  explicit Drive(const DriveConfig& config = {}) : control(config) {}

  DriveControl control;
  HealthyRobot robot;
  DriveInputs in;  ///< what is not the healthy robot's stays as it is set
  Time now = Time(std::chrono::seconds(100));
  Time next_message = now;
  std::optional<DrawnWorld> world;

  DriveOutput tick(Duration by = milliseconds(20)) {
    now += by;
    in.scan = robot.scan(now);
    if (world) in.scan = std::make_shared<Scan>(scan_of(*world, in.scan->stamp, 1200 + odd(in.scan->stamp)));
    in.imu = robot.imu(now);
    in.motors = Stamped<MotorState>{now, motors};
    in.pins = Stamped<PinState>{now, pins};
    return control.step(now, in);
  }
  DriveOutput tick_with(const Twist& twist) {
    if (now + milliseconds(20) >= next_message) {
      say(twist, next_message);
      next_message += milliseconds(50);
    }
    return tick();
  }
  DriveOutput run(double seconds, const Twist& twist) {
    DriveOutput out;
    for (int i = 0; i < seconds * 50 - 0.5; ++i) out = tick_with(twist);
    return out;
  }
  void say(const Twist& twist, Time heard) {
    in.command = DriveCommand{in.command ? in.command->seq + 1 : 1, twist, heard};
  }
  static std::size_t odd(Time stamp) {
    return static_cast<std::size_t>(stamp.time_since_epoch() / milliseconds(100) % 2);
  }

  MotorState motors{12.5, false, false, true};
  PinState pins;
};

TEST(DriveControl, DrivesWhenAskedTo) {
  Drive d;
  EXPECT_EQ(d.run(0.4, kStand).verdict.motion, Motion::kStop);
  EXPECT_EQ(d.run(0.2, kStand).verdict, (Verdict{Motion::kGo, ""}));
  const DriveOutput out = d.run(1.0, kForward);
  EXPECT_NEAR(out.applied.v_mps, 0.6, 1e-9);
  EXPECT_GT(out.power.left, 0.2);
  EXPECT_EQ(out.power.left, out.power.right);
  EXPECT_EQ(d.run(1.0, kStand).power, WheelPower{});
}

TEST(DriveControl, ACommandReachesTheWheelsInTheTickThatTakesIt) {
  Drive d;
  d.run(1.0, kStand);
  d.say(kForward, d.now + milliseconds(20));
  EXPECT_GT(d.tick().power.left, 0.0);
}

/// Over random phases of messages and ticks, with ticks alone and with a wake-up at the deadline.
TEST(DriveControl, FromTheLastHeartbeatToMotorsOffIsNeverOver220Milliseconds) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> phase_us(0, 49'999), message_us(20'000, 60'000);
  double longest_s = 0, longest_woken_s = 0;
  for (int trial = 0; trial < 500; ++trial) {
    for (const bool woken : {false, true}) {
      Drive d;
      d.run(0.7, kStand);
      const DriveOutput driving = d.run(0.5, kForward);
      ASSERT_GT(driving.power.left, 0.0);
      const Time last = d.now + microseconds(phase_us(random));
      for (Time t = d.now; t < last; t += microseconds(message_us(random))) {
        d.say(kForward, t);
        while (d.now + milliseconds(20) < t) d.tick();
      }
      while (d.now + milliseconds(20) < last) d.tick();
      d.say(kForward, last);
      DriveOutput out;
      int ticks = 0;
      do {
        Duration step = milliseconds(20);
        if (woken && d.control.deadline() && d.now >= last)
          step = std::min(step, *d.control.deadline() - d.now);
        out = d.tick(step);
      } while (out.power != WheelPower{} && ++ticks < 100);
      ASSERT_EQ(out.power, WheelPower{});
      EXPECT_EQ(out.applied, kStand);
      auto& longest = woken ? longest_woken_s : longest_s;
      longest = std::max(longest, to_seconds(d.now - last));
      EXPECT_GE(d.now - last, milliseconds(200)) << "nor any sooner";
    }
  }
  EXPECT_LE(longest_s, 0.22);
  EXPECT_GT(longest_s, 0.215) << "the phases were not spread";
  EXPECT_LE(longest_woken_s, 0.200000001);
}

TEST(DriveControl, AfterALossAHeldStickDoesNotDrive) {
  Drive d;
  d.run(0.7, kStand);
  d.run(0.5, kForward);
  for (int i = 0; i < 15; ++i) d.tick();
  d.next_message = d.now;
  EXPECT_EQ(d.run(5, kForward).power, WheelPower{});
  EXPECT_EQ(d.run(0.1, kForward).verdict.reason, "let go of the stick, then push again");
  d.run(0.1, kStand);
  EXPECT_GT(d.run(0.2, kForward).power.left, 0.0);
}

TEST(DriveControl, AfterAnyStopAHeldStickDoesNotDrive) {
  const auto cases = {
      +[](Drive& d, bool on) { d.pins.estop_pressed = on, d.in.clear_asked = !on; },
      +[](Drive& d, bool on) {
        d.in.stop_asked.reset(), d.in.clear_asked = !on;
        if (on) d.in.stop_asked = "me";
      },
      +[](Drive& d, bool on) { d.motors.failsafe_on = !on; },
  };
  for (const auto& stop : cases) {
    Drive d;
    d.run(0.7, kStand);
    ASSERT_GT(d.run(0.5, kForward).power.left, 0.0);
    stop(d, true);
    EXPECT_EQ(d.tick_with(kForward).power, WheelPower{}) << "at once";
    EXPECT_EQ(d.run(1, kForward).power, WheelPower{});
    stop(d, false);
    EXPECT_EQ(d.run(2, kForward).power, WheelPower{}) << "let go first";
    EXPECT_EQ(d.run(0.1, kStand).verdict, (Verdict{Motion::kGo, ""}));
    EXPECT_GT(d.run(0.2, kForward).power.left, 0.0);
  }
}

TEST(DriveControl, ThePowerLimitScalesTheStick) {
  for (const double limit : {1.0, 0.5, 0.1}) {
    Drive d;
    d.in.power_limit = limit;
    d.run(0.7, kStand);
    EXPECT_NEAR(d.run(2, kForward).applied.v_mps, limit * 0.6, 1e-9);
  }
  for (const double none : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    Drive d;
    d.in.power_limit = none;
    d.run(0.7, kStand);
    EXPECT_EQ(d.run(2, kForward).power, WheelPower{});
  }
  Drive d;
  d.in.power_limit = 7.0;
  d.run(0.7, kStand);
  EXPECT_NEAR(d.run(2, kForward).applied.v_mps, 0.6, 1e-9);
}

TEST(DriveControl, ABrownoutCutsThePowerAndGivesItBackSlowly) {
  Drive d;
  d.run(0.7, kStand);
  d.run(1, kForward);
  d.motors.battery_v = 9.0;
  DriveOutput out = d.tick_with(kForward);
  EXPECT_TRUE(out.battery.brownout);
  EXPECT_TRUE(out.battery_changed);
  EXPECT_EQ(out.verdict.motion, Motion::kSlow);
  d.motors.battery_v = 12.5;
  out = d.run(1, kForward);
  EXPECT_NEAR(out.applied.v_mps, 0.7 * 0.6, 1e-6);
  EXPECT_EQ(out.verdict.reason, "battery or 5 V supply broke down under load: power cut to 70 %");
  EXPECT_NEAR(d.run(6, kForward).applied.v_mps, 0.6, 1e-6);
}

TEST(DriveControl, TheComputersLowSupplyCutsThePowerOfAFullBattery) {
  Drive d;
  d.run(0.7, kStand);
  EXPECT_NEAR(d.run(1, kForward).applied.v_mps, 0.6, 1e-6);
  d.in.supply_low = true;
  const DriveOutput out = d.run(0.8, kForward);
  EXPECT_NEAR(out.applied.v_mps, 0.7 * 0.6, 1e-6);
  EXPECT_EQ(out.verdict.motion, Motion::kSlow);
  EXPECT_EQ(out.cause, Cause::kBrownout);
  EXPECT_EQ(out.battery.level, BatteryLevel::kGood);
  d.in.supply_low = false;
  EXPECT_NEAR(d.run(7, kForward).applied.v_mps, 0.6, 1e-6);
}

TEST(DriveControl, HoldsBeforeAWallAndBacksOff) {
  Drive d;
  d.world = wall_at(0.2);
  d.run(0.7, kStand);
  DriveOutput out = d.run(1, kForward);
  EXPECT_EQ(out.power, WheelPower{});
  EXPECT_EQ(out.verdict.motion, Motion::kHold);
  EXPECT_EQ(out.verdict.reason, "obstacle 0.06 m ahead");
  out = d.run(1, {-0.6, 0});
  EXPECT_EQ(out.verdict.motion, Motion::kGo);
  EXPECT_LT(out.power.left, 0.0);
}

TEST(DriveControl, SlowsDownForAWall) {
  Drive d;
  d.world = wall_at(0.55);
  d.run(0.7, kStand);
  const DriveOutput out = d.run(1, {1.0, 0.2});
  EXPECT_EQ(out.verdict.motion, Motion::kSlow);
  EXPECT_GT(out.applied.v_mps, 0.1);
  EXPECT_LT(out.applied.v_mps, 0.7);
  EXPECT_NEAR(out.applied.w_radps, 0.2 * out.applied.v_mps, 1e-6) << "on the same arc";
}

TEST(DriveControl, SlowingDownIsOneTransitionThoughEachScanGivesALittleWay) {
  Drive d;
  d.world = wall_at(0.8);  // which keeps away
  d.run(0.7, kStand);
  const std::size_t before = d.control.transitions().size();
  EXPECT_EQ(d.run(3, {1.5, 0.2}).verdict.motion, Motion::kSlow);
  EXPECT_EQ(d.control.transitions().size(), before + 1);
  d.run(1, kStand);
  EXPECT_EQ(d.control.transitions().back().verdict, (Verdict{Motion::kGo, ""}));
}

TEST(DriveControl, ListsTransitionsOnceEach) {
  Drive d;
  d.run(1.0, kStand);
  EXPECT_EQ(d.run(1.0, kForward).cause, Cause::kNone);
  d.in.stop_asked = "from the page";
  EXPECT_EQ(d.run(0.5, kForward).cause, Cause::kStopAsked);
  std::vector<std::string> reasons;
  for (const auto& t : d.control.transitions()) reasons.push_back(t.verdict.reason);
  EXPECT_THAT(reasons, testing::ElementsAre("waiting for the connection to the driver to be steady", "",
                                            "stopped: from the page; clear the stop to go on"));
}

TEST(DriveControl, TheListOfTransitionsIsBounded) {
  Drive d;
  d.run(1.0, kStand);
  for (int i = 0; i < 500; ++i) {
    d.motors.failsafe_on = i % 2 == 0;
    d.tick_with(kStand);
  }
  EXPECT_EQ(d.control.transitions().size(), DriveControl::kMostTransitions);
  EXPECT_EQ(d.control.transitions().back().time, d.now);
}

TEST(DriveConfig, EveryTableNamesItsFieldsAndDefaultsLieWithinTheLimits) {
  const DriveConfig config;
  int tables = 0, fields = 0;
  DriveConfig::sections(config, [&](std::string_view table, const auto& section) {
    ++tables;
    std::decay_t<decltype(section)>::fields(section, [&](const Field& field, double value) {
      ++fields;
      EXPECT_GE(value, field.min) << table << "." << field.name;
      EXPECT_LE(value, field.max) << table << "." << field.name;
      EXPECT_FALSE(field.doc.empty());
    });
  });
  EXPECT_EQ(tables, 7);
  EXPECT_EQ(fields, 2 + 2 + 12 + 8 + 10 + 10 + 17);
}

}  // namespace
}  // namespace dynslam
