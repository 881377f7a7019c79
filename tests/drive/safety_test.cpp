// SPDX-License-Identifier: MIT
#include "drive/safety.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "drive/good_inputs.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Twist kDriven{0.5, 0.0};

/// A robot that drives well for a second; then something happens to its inputs.
class Bench {
 public:
  using Event = std::function<void(SafetyInputs& in, int ms)>;  ///< ms after the good second

  explicit Bench(const BodyConfig& body = {}) : safety_({}, body, {}) {
    for (int ms = 0; ms < 1000; ms += 10) step(ms, {});
  }

  Decision step(int ms, const Event& event) {
    const Time now = at(ms);
    SafetyInputs in;
    in.twist = kDriven;
    in.scan = robot_.scan(now);
    in.imu = robot_.imu(now);
    in.motors = robot_.motors(now);
    in.pins = robot_.pins(now);
    in.battery = {12.5, 0.8, BatteryLevel::kGood, false};
    if (event) event(in, ms - 1000);
    const Decision d = safety_.decide(now, in);
    const Twist driven{d.share * in.twist.v_mps, d.share * in.twist.w_radps};
    safety_.driven(now, driven, {driven.v_mps, driven.v_mps}, in.imu);
    return d;
  }

  /// What is decided so long after the event began.
  Decision after(int ms, const Event& event) {
    for (int t = 0; t < ms; t += 10) step(1000 + t, event);
    return step(1000 + ms, event);
  }

  static Time at(int ms) { return Time(std::chrono::seconds(100) + milliseconds(ms)); }

 private:
  HealthyRobot robot_;
  Safety safety_;
};

/// A moment of the event.
constexpr Time event_ms(int ms) { return Time(std::chrono::seconds(101) + milliseconds(ms)); }

// The events. "Frozen" is a device that gives the last value of before.
void estop_pressed(SafetyInputs& in, int) { in.pins->value.estop_pressed = true; }
void estop_tapped(SafetyInputs& in, int ms) { in.pins->value.estop_pressed = ms == 0; }
void estop_tapped_and_cleared(SafetyInputs& in, int ms) {
  in.pins->value.estop_pressed = ms < 100;
  in.clear_asked = true;
}
void estop_cleared_while_pressed(SafetyInputs& in, int) {
  in.pins->value.estop_pressed = true;
  in.clear_asked = true;
}
void estop_bounces_while_cleared(SafetyInputs& in, int ms) {
  in.pins->value.estop_pressed = ms % 50 == 0;
  in.clear_asked = true;
}
void estop_pressed_in_the_future(SafetyInputs& in, int) { in.pins = {event_ms(60'000), {true}}; }
void estop_tapped_then_silent(SafetyInputs& in, int ms) {
  in.pins = {event_ms(std::min(ms, 100)), {ms < 50}};
  in.clear_asked = ms > 700;
}
void pins_frozen(SafetyInputs& in, int) { in.pins->stamp = event_ms(0); }
void pins_gone(SafetyInputs& in, int ms) {
  if (ms > 0) in.pins.reset();
}
void pins_of_the_future(SafetyInputs& in, int ms) {
  if (ms > 0) in.pins->stamp += std::chrono::hours(1);
}
void stop_asked_once(SafetyInputs& in, int ms) {
  if (ms == 0) in.stop_asked = "from the page";
}
void stop_asked_and_cleared(SafetyInputs& in, int ms) {
  if (ms == 0) in.stop_asked = "from the page";
  in.clear_asked = ms == 0 || ms == 200;
}
void motors_frozen(SafetyInputs& in, int) { in.motors->stamp = event_ms(0); }
void motors_gone(SafetyInputs& in, int ms) {
  if (ms > 0) in.motors.reset();
}
void motors_of_the_future(SafetyInputs& in, int ms) {
  if (ms > 0) in.motors->stamp += std::chrono::hours(1);
}
void failsafe_off(SafetyInputs& in, int) { in.motors->value.failsafe_on = false; }
void left_fault(SafetyInputs& in, int) { in.motors->value.left_fault = true; }
void both_fault(SafetyInputs& in, int) { in.motors->value.left_fault = in.motors->value.right_fault = true; }
void flickering_fault(SafetyInputs& in, int ms) { in.motors->value.right_fault = ms % 200 != 0; }
void scan_frozen(SafetyInputs& in, int) {
  static HealthyRobot robot;
  auto scan = std::make_shared<Scan>(*robot.scan(event_ms(0)));
  scan->stamp = event_ms(0);
  in.scan = scan;
}
void scan_repeats(SafetyInputs& in, int ms) {
  auto scan = std::make_shared<Scan>(scan_of(wall_at(2), event_ms(ms), 100));
  in.scan = scan;
}
void hall_repeats(SafetyInputs& in, int ms) {
  in.scan = std::make_shared<Scan>(scan_of(wall_at(15), event_ms(ms), 100));
}
void scan_without_returns(SafetyInputs& in, int ms) {
  in.scan = std::make_shared<Scan>(scan_of(ms > 0 ? DrawnWorld{} : wall_at(15), event_ms(ms), 100));
}
void scan_blind(SafetyInputs& in, int ms) {
  auto scan = std::make_shared<Scan>(scan_of(wall_at(15), event_ms(ms), 100));
  if (ms > 0) {
    for (Beam& b : scan->beams) b.range_m = static_cast<float>(kNan);
  }
  in.scan = scan;
}
void scan_without_beams(SafetyInputs& in, int ms) {
  auto scan = std::make_shared<Scan>(scan_of(wall_at(15), event_ms(ms), ms > 0 ? 0 : 100));
  in.scan = scan;
}
void scan_of_the_future(SafetyInputs& in, int ms) {
  auto scan = std::make_shared<Scan>(scan_of(wall_at(15), event_ms(ms), 100));
  if (ms > 0) scan->stamp += std::chrono::seconds(1);
  in.scan = scan;
}
void scan_goes_back(SafetyInputs& in, int ms) {
  in.scan = std::make_shared<Scan>(scan_of(wall_at(15), event_ms(-ms), 100));
}
void lean_24(SafetyInputs& in, int) { in.imu->world_q_robot = leaning(24) * in.imu->world_q_robot; }
void lean_31(SafetyInputs& in, int) { in.imu->world_q_robot = leaning(31); }
void roll_back_31(SafetyInputs& in, int) {
  in.imu->world_q_robot = leaning(140, Eigen::Vector3d::UnitZ()) * leaning(-31, Eigen::Vector3d::UnitX());
}
void upside_down(SafetyInputs& in, int) { in.imu->world_q_robot = leaning(180, Eigen::Vector3d::UnitX()); }
void lean_spikes(SafetyInputs& in, int ms) {
  if (ms % 50 == 0) in.imu->world_q_robot = leaning(60);
}
void lean_for_a_while(SafetyInputs& in, int ms) {
  if (ms < 300) in.imu->world_q_robot = leaning(31);
}
void lean_then_silent(SafetyInputs& in, int ms) {
  in.imu->world_q_robot = leaning(31);
  in.imu->stamp = event_ms(std::min(ms, 200));
}
void imu_silent(SafetyInputs& in, int) { in.imu->stamp = event_ms(0); }
void imu_gone(SafetyInputs& in, int ms) {
  if (ms > 0) in.imu.reset();
}
void imu_zero(SafetyInputs& in, int ms) {
  if (ms > 0) in.imu->world_q_robot = Eigen::Quaterniond(0, 0, 0, 0);
}
void imu_nan(SafetyInputs& in, int ms) {
  if (ms > 0) in.imu->world_q_robot = Eigen::Quaterniond(1, kNan, 0, 0);
}
void imu_of_the_future(SafetyInputs& in, int ms) {
  if (ms > 0) in.imu->stamp += std::chrono::hours(1);
}
void imu_repeats(SafetyInputs& in, int) { in.imu->world_q_robot = leaning(1); }
void imu_repeats_standing(SafetyInputs& in, int) {
  in.imu->world_q_robot = leaning(1);
  in.twist = {};
}
void driver_missing(SafetyInputs& in, int) { in.driver_missing = "nobody is driving"; }
void brownout(SafetyInputs& in, int) {
  in.battery.brownout = true;
  in.battery_power = 0.7;
}
void still_recovering(SafetyInputs& in, int) { in.battery_power = 0.9; }
void nearly_empty(SafetyInputs& in, int) { in.battery.level = BatteryLevel::kRecharge; }
void low(SafetyInputs& in, int) { in.battery.level = BatteryLevel::kLow; }
std::shared_ptr<const Scan> wall_scan(double x, int ms) {
  return std::make_shared<Scan>(scan_of(wall_at(x), event_ms(ms - ms % 100), 1200 + ms / 100 % 2));
}
void wall_near(SafetyInputs& in, int ms) { in.scan = wall_scan(0.4, ms); }
void wall_touching(SafetyInputs& in, int ms) { in.scan = wall_scan(0.2, ms); }
void wall_behind(SafetyInputs& in, int ms) { in.scan = wall_scan(-0.2, ms); }
void into_wall_behind(SafetyInputs& in, int ms) {
  in.scan = wall_scan(-0.2, ms);
  in.twist = {-0.5, 0};
}
void bumper_pressed(SafetyInputs& in, int) { in.pins->value.bumper_pressed = true; }
void bumper_pressed_and_back(SafetyInputs& in, int ms) {
  bumper_pressed(in, ms);
  if (ms > 50) in.twist = {-0.1, 0.0};
}
void bumper_pressed_and_turned(SafetyInputs& in, int ms) {
  bumper_pressed(in, ms);
  if (ms > 50) in.twist = {0.0, 0.5};
}
void no_room_to_turn(SafetyInputs& in, int ms) {
  in.scan = wall_scan(0.142, ms);
  in.twist = {0, 1};
}

struct Row {
  const char* name;
  void (*event)(SafetyInputs&, int ms);
  int at_ms;
  Motion motion;
  Cause cause;
  const char* words;
};

using enum Motion;
const Row kRows[] = {
    {"pressed", estop_pressed, 0, kEStop, Cause::kEStopPin,
     "e-stop pressed: release it, then clear the stop"},
    {"tapped", estop_tapped, 5000, kEStop, Cause::kEStopPin, "e-stop was pressed: clear the stop to go on"},
    {"held", estop_cleared_while_pressed, 5000, kEStop, Cause::kEStopPin, "release it"},
    {"released 49", estop_tapped_and_cleared, 149, kEStop, Cause::kEStopPin, "clear the stop"},
    {"released 50", estop_tapped_and_cleared, 150, kGo, Cause::kNone, ""},
    {"bounces", estop_bounces_while_cleared, 1040, kEStop, Cause::kEStopPin, "clear the stop"},
    {"pressed, nonsense stamp", estop_pressed_in_the_future, 500, kEStop, Cause::kEStopPin, "e-stop pressed"},
    {"cleared unseen", estop_tapped_then_silent, 800, kEStop, Cause::kEStopPin, "clear the stop"},
    {"pins 500", pins_frozen, 500, kGo, Cause::kNone, ""},
    {"pins 501", pins_frozen, 501, kStop, Cause::kPinsSilent, "e-stop not read for 0.5 s"},
    {"pins gone", pins_gone, 600, kStop, Cause::kPinsSilent, "e-stop not read for 0.6 s"},
    {"pins future", pins_of_the_future, 600, kStop, Cause::kPinsSilent, "e-stop not read for 0.6 s"},
    {"stop", stop_asked_once, 0, kEStop, Cause::kStopAsked,
     "stopped: from the page; clear the stop to go on"},
    {"stop stays", stop_asked_once, 5000, kEStop, Cause::kStopAsked, "from the page"},
    {"stop beats clear", stop_asked_and_cleared, 199, kEStop, Cause::kStopAsked, "from the page"},
    {"stop cleared", stop_asked_and_cleared, 200, kGo, Cause::kNone, ""},
    {"motors 500", motors_frozen, 500, kGo, Cause::kNone, ""},
    {"motors 501", motors_frozen, 501, kStop, Cause::kMotorsSilent, "motor board does not answer for 0.5 s"},
    {"motors gone", motors_gone, 800, kStop, Cause::kMotorsSilent, "does not answer for 0.8 s"},
    {"motors future", motors_of_the_future, 501, kStop, Cause::kMotorsSilent, "does not answer"},
    {"failsafe", failsafe_off, 0, kStop, Cause::kFailsafeOff, "failsafe is off"},
    {"fault 199", left_fault, 199, kGo, Cause::kNone, ""},
    {"fault 200", left_fault, 200, kGo, Cause::kNone, ""},
    {"fault 201", left_fault, 201, kStop, Cause::kMotorFault, "fault at the left motor"},
    {"both faults", both_fault, 300, kStop, Cause::kMotorFault, "fault at both motors"},
    {"fault flickers", flickering_fault, 2190, kGo, Cause::kNone, ""},
    {"scan 350", scan_frozen, 350, kGo, Cause::kNone, ""},
    {"scan 351", scan_frozen, 351, kStop, Cause::kScan, "no lidar data for 0.4 s"},
    {"scan repeats 350", scan_repeats, 350, kGo, Cause::kNone, ""},
    {"scan repeats 351", scan_repeats, 351, kStop, Cause::kScan, "the lidar repeats the same scan for 0.4 s"},
    {"an empty hall repeats", hall_repeats, 2000, kGo, Cause::kNone, ""},
    {"blind 350", scan_blind, 350, kGo, Cause::kNone, ""},
    {"blind 351", scan_blind, 351, kStop, Cause::kScan, "the lidar sees nothing valid for 0.4 s"},
    {"no returns 350", scan_without_returns, 350, kGo, Cause::kNone, ""},
    {"no returns 351", scan_without_returns, 351, kStop, Cause::kScan, "sees nothing valid"},
    {"no beams", scan_without_beams, 351, kStop, Cause::kScan, "sees nothing valid"},
    {"scan future", scan_of_the_future, 351, kStop, Cause::kScan, "stamps are ahead of the clock"},
    {"scan goes back", scan_goes_back, 351, kStop, Cause::kScan, "no lidar data for 0.4 s"},
    {"lean 24", lean_24, 5000, kGo, Cause::kNone, ""},
    {"lean 31, 99", lean_31, 99, kGo, Cause::kNone, ""},
    {"lean 31, 100", lean_31, 100, kStop, Cause::kTilt, "tilted by 31 degrees"},
    {"roll", roll_back_31, 100, kStop, Cause::kTilt, "tilted by 31 degrees"},
    {"upside down", upside_down, 100, kStop, Cause::kTilt, "tilted by 180 degrees"},
    {"lean spikes", lean_spikes, 2000, kGo, Cause::kNone, ""},
    {"upright 399", lean_for_a_while, 399, kStop, Cause::kTilt, "tilted"},
    {"upright 400", lean_for_a_while, 400, kGo, Cause::kNone, ""},
    {"lean, silent", lean_then_silent, 9000, kStop, Cause::kTilt, "tilted by 31 degrees"},
    {"imu 500", imu_silent, 500, kGo, Cause::kNone, ""},
    {"imu 501", imu_silent, 501, kSlow, Cause::kImu, "IMU silent for 0.5 s: slow"},
    {"imu gone", imu_gone, 700, kSlow, Cause::kImu, "IMU silent for 0.7 s"},
    {"imu zero", imu_zero, 501, kSlow, Cause::kImu, "IMU silent"},
    {"imu nan", imu_nan, 501, kSlow, Cause::kImu, "IMU silent"},
    {"imu future", imu_of_the_future, 501, kSlow, Cause::kImu, "IMU silent"},
    {"imu repeats 500", imu_repeats, 500, kGo, Cause::kNone, ""},
    {"imu repeats 501", imu_repeats, 501, kSlow, Cause::kImu, "IMU frozen"},
    {"imu repeats, standing", imu_repeats_standing, 5000, kGo, Cause::kNone, ""},
    {"driver", driver_missing, 0, kStop, Cause::kDriver, "nobody is driving"},
    {"brownout", brownout, 0, kSlow, Cause::kBrownout, "power cut to 70 %"},
    {"after a brownout", still_recovering, 0, kSlow, Cause::kBrownout, "power cut to 90 %"},
    {"empty", nearly_empty, 0, kSlow, Cause::kBattery, "battery nearly empty: recharge it"},
    {"low", low, 0, kGo, Cause::kNone, ""},
    {"wall near", wall_near, 0, kSlow, Cause::kObstacle, "obstacle 0.26 m ahead"},
    {"wall touching", wall_touching, 0, kHold, Cause::kObstacle, "obstacle 0.06 m ahead"},
    {"wall behind", wall_behind, 0, kGo, Cause::kNone, ""},
    {"into wall behind", into_wall_behind, 0, kHold, Cause::kObstacle, "obstacle 0.06 m behind"},
    {"bumper", bumper_pressed, 0, kHold, Cause::kTouch, "touching something: drive the other way"},
    {"bumper, away", bumper_pressed_and_back, 100, kGo, Cause::kNone, ""},
    {"bumper, on the spot", bumper_pressed_and_turned, 100, kHold, Cause::kTouch, "touching"},
    {"no room", no_room_to_turn, 0, kHold, Cause::kObstacle, "m beside"},
};

TEST(Safety, EveryRowSaysWhatItShouldWhenItShould) {
  for (const Row& row : kRows) {
    Bench bench;
    const Decision d = bench.after(row.at_ms, row.event);
    EXPECT_STREQ(to_string(d.worst.verdict.motion), to_string(row.motion)) << row.name;
    EXPECT_EQ(d.worst.cause, row.cause) << row.name << ": " << d.worst.verdict.reason;
    EXPECT_THAT(d.worst.verdict.reason, HasSubstr(row.words)) << row.name;
    EXPECT_EQ(d.worst.verdict.reason.empty(), row.motion == kGo) << row.name;
    EXPECT_EQ(d.share == 0.0, row.motion >= kHold) << row.name;
    EXPECT_TRUE(d.share == 1.0 || row.motion != kGo) << row.name;
  }
}

TEST(Safety, TheWorstWinsAndAmongEqualsTheFirstRow) {
  struct Fault {
    Bench::Event event;
    Motion motion;
    Cause cause;
  };
  const Fault faults[] = {
      {estop_pressed, kEStop, Cause::kEStopPin},    {stop_asked_once, kEStop, Cause::kStopAsked},
      {motors_frozen, kStop, Cause::kMotorsSilent}, {lean_31, kStop, Cause::kTilt},
      {scan_frozen, kStop, Cause::kScan},           {driver_missing, kStop, Cause::kDriver},
      {nearly_empty, kSlow, Cause::kBattery}};
  constexpr int kAll = 1 << std::size(faults);
  for (int chosen = 0; chosen < kAll; ++chosen) {
    Fault worst{{}, kGo, Cause::kNone};
    for (std::size_t i = 0; i < std::size(faults); ++i) {
      if ((chosen >> i & 1) && faults[i].motion > worst.motion) worst = faults[i];
    }
    Bench bench;
    const Decision d = bench.after(600, [&](SafetyInputs& in, int ms) {
      for (std::size_t i = 0; i < std::size(faults); ++i) {
        if (chosen >> i & 1) faults[i].event(in, ms);
      }
    });
    EXPECT_EQ(d.worst.verdict.motion, worst.motion) << chosen;
    EXPECT_EQ(d.worst.cause, worst.cause) << chosen;
  }
}

TEST(Safety, NothingKnownIsAStop) {
  Safety safety({}, {}, {});
  const Decision d = safety.decide(Time(), {});
  EXPECT_EQ(d.worst.verdict, (Verdict{kStop, "motor board does not answer"}));
  EXPECT_EQ(d.share, 0.0);
}

TEST(Safety, ARobotWithoutImuOrEStopMayDrive) {
  Safety safety({}, {}, {});
  HealthyRobot robot;
  SafetyInputs in;
  in.twist = kDriven;
  in.scan = robot.scan(Bench::at(0));
  EXPECT_EQ(safety.decide(Bench::at(0), in).worst.verdict.reason, "motor board does not answer");
  in.motors = robot.motors(Bench::at(0));
  EXPECT_EQ(safety.decide(Bench::at(0), in).worst.verdict, (Verdict{kGo, ""}));
  in.scan = nullptr;
  Safety blind({}, {}, {});
  EXPECT_EQ(blind.decide(Bench::at(0), in).worst.verdict, (Verdict{kStop, "no lidar data yet"}));
}

TEST(Safety, AnEStopThatWasNeverReadStops) {
  Safety safety({}, {}, {});
  HealthyRobot robot;
  SafetyInputs in;
  in.scan = robot.scan(Bench::at(0));
  in.motors = robot.motors(Bench::at(0));
  in.has_estop = true;
  EXPECT_EQ(safety.decide(Bench::at(0), in).worst.verdict, (Verdict{kStop, "e-stop not read"}));
  in.pins = robot.pins(Bench::at(10));
  EXPECT_EQ(safety.decide(Bench::at(10), in).worst.verdict, (Verdict{kGo, ""}));
}

TEST(Safety, AnImuThatNeverSpeaksIsMissed) {
  Safety safety({}, {}, {});
  HealthyRobot robot;
  for (int ms = 0; ms <= 510; ms += 10) {
    SafetyInputs in;
    in.scan = robot.scan(Bench::at(ms));
    in.motors = robot.motors(Bench::at(ms));
    in.has_imu = true;
    EXPECT_EQ(safety.decide(Bench::at(ms), in).worst.verdict.motion, ms <= 500 ? kGo : kSlow) << ms;
  }
}

TEST(Safety, AnImuThatGivesNonsenseFromTheStartIsMissed) {
  Safety safety({}, {}, {});
  HealthyRobot robot;
  Decision d;
  for (int ms = 0; ms <= 510; ms += 10) {
    const Time now = Bench::at(ms);
    SafetyInputs in;
    in.scan = robot.scan(now);
    in.motors = robot.motors(now);
    in.imu = ImuSample{now, Eigen::Quaterniond(0, 0, 0, 0)};
    d = safety.decide(now, in);
    EXPECT_EQ(d.worst.verdict.motion, ms <= 500 ? kGo : kSlow) << ms;
  }
  EXPECT_THAT(d.worst.verdict.reason, HasSubstr("IMU gave nothing valid for 0.5 s"));
}

TEST(Safety, FaultBitsSayNothingUntilBothMotorsWereDriven) {
  Safety safety({}, {}, {});
  HealthyRobot robot;
  const auto step = [&](int ms, const WheelPower& power) {
    const Time now = Bench::at(ms);
    SafetyInputs in;
    in.scan = robot.scan(now);
    in.motors = robot.motors(now);
    in.motors->value.left_fault = in.motors->value.right_fault = true;
    const Decision d = safety.decide(now, in);
    safety.driven(now, {}, power, {});
    return d.worst.cause;
  };
  for (int ms = 0; ms < 1000; ms += 20) EXPECT_EQ(step(ms, {}), Cause::kNone);
  for (int ms = 1000; ms < 2000; ms += 20) EXPECT_EQ(step(ms, {0.5, 0}), Cause::kNone);
  EXPECT_EQ(step(2000, {0, 0.5}), Cause::kNone);
  for (int ms = 2020; ms <= 2220; ms += 20) EXPECT_EQ(step(ms, {}), Cause::kNone) << ms;
  EXPECT_EQ(step(2240, {}), Cause::kMotorFault);
}

TEST(Safety, AClockThatRunsBackwardsStopsAndFreesNothing) {
  Bench bench;
  const Decision d = bench.step(500, {});
  EXPECT_EQ(d.worst.cause, Cause::kClock);
  EXPECT_EQ(d.worst.verdict, (Verdict{kStop, "the clock ran backwards"}));
  EXPECT_EQ(bench.step(700, {}).worst.verdict.motion, kGo) << "all is heard of again since";

  Bench pressed;
  pressed.step(1000, estop_tapped);
  for (const int ms : {0, 10, 500, 400, 2000})
    EXPECT_EQ(pressed.step(ms, {}).worst.cause, Cause::kEStopPin) << ms;
  Bench tilted;
  tilted.after(300, lean_31);
  EXPECT_EQ(tilted.step(900, {}).worst.cause, Cause::kClock);
  EXPECT_EQ(tilted.step(910, {}).worst.cause, Cause::kTilt) << "until it has been upright for a while";
}

/// One device alone goes on giving what it gave before the clock ran backwards, and is from the future now.
TEST(Safety, AnOldValueIsOfNoUseAfterTheClockRanBackwards) {
  struct Case {
    void (*stale)(SafetyInputs&, int);
    Motion motion;
    Cause cause;
  };
  const Case cases[] = {
      {[](SafetyInputs& in, int) { in.motors->stamp = event_ms(-10); }, kStop, Cause::kMotorsSilent},
      {[](SafetyInputs& in, int) { in.pins->stamp = event_ms(-10); }, kStop, Cause::kPinsSilent},
      {[](SafetyInputs& in, int) {
         in.scan = std::make_shared<Scan>(scan_of(wall_at(15), event_ms(-10), 100));
       },
       kStop, Cause::kScan},
      {[](SafetyInputs& in, int) { in.scan.reset(); }, kStop, Cause::kScan},
      {[](SafetyInputs& in, int) { in.imu->stamp = event_ms(-10); }, kSlow, Cause::kImu},
      {[](SafetyInputs& in, int) { in.imu.reset(); }, kSlow, Cause::kImu}};
  for (const Case& c : cases) {
    Bench bench;
    bench.step(0, c.stale);
    for (int ms = 10; ms < 900; ms += 10) {
      const Decision d = bench.step(ms, c.stale);
      EXPECT_EQ(d.worst.verdict.motion, c.motion) << ms;
      EXPECT_EQ(d.worst.cause, c.cause) << ms << " " << d.worst.verdict.reason;
    }
  }
}

TEST(Safety, CareMeansSlowly) {
  for (const Bench::Event& event : {Bench::Event(nearly_empty), Bench::Event(imu_repeats)}) {
    for (const Twist& t : {Twist{1.2, 0}, Twist{-1.2, 0.5}, Twist{0, 3}, Twist{0.2, 2}}) {
      Bench bench;
      const Decision d = bench.after(600, [&](SafetyInputs& in, int ms) {
        event(in, ms);
        if (ms == 600) in.twist = t;
      });
      EXPECT_LE(std::abs(t.v_mps) * d.share, 0.3 + 1e-9);
      EXPECT_LE(std::abs(t.w_radps) * d.share, 1.0 + 1e-9);
      EXPECT_GT(d.share, 0.2);
    }
  }
}

}  // namespace
}  // namespace dynslam
