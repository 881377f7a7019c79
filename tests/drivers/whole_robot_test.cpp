// SPDX-License-Identifier: MIT
// The whole daemon on its real drivers and emulated hardware: what it does when a device goes and comes back.
// Times are those of the design, with some room for a busy computer where a thread of this test takes part.
#include "drivers/whole_robot.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "io/open_recording.h"
#include "sim/small_world.h"

namespace dynslam::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Of a busy computer.
constexpr double kBusy_s = 0.4;
constexpr double kPatience_s = 20.0;
constexpr Twist kTurning{0.0, 1.5};

class WholeRobotTest : public WholeRobot {
 protected:
  /// Turning on the spot, with all that it has.
  void start_turning() {
    begin(bare_room());
    start();
    hold(kTurning);
    ASSERT_TRUE(comes_true(kPatience_s, [&] { return goes(); })) << state();
    ASSERT_TRUE(comes_true(kPatience_s, [&] { return drive().verdict.motion == Motion::kGo; })) << state();
  }
  bool is_stopped_by(Cause cause) {
    const DriveState state = drive();
    return state.cause == cause && state.verdict.motion >= Motion::kStop && state.power == WheelPower{};
  }
  void expect_stop_within(double seconds, Cause cause) {
    const auto took_s = comes_true(kPatience_s, [&] { return is_stopped_by(cause); });
    ASSERT_TRUE(took_s) << state();
    EXPECT_LE(*took_s, seconds + kBusy_s);
    EXPECT_TRUE(comes_true(1.0 + kBusy_s, [&] { return stands(); })) << "the wheels roll on";
  }
  void expect_trouble(const std::string& name, const std::string& words) {
    // What it says first, and what it says once it has tried again, may differ.
    EXPECT_TRUE(comes_true(kPatience_s, [&] { return trouble(name).find(words) != std::string::npos; }))
        << state();
    EXPECT_GE(device(name)["errors"], 1);
    EXPECT_TRUE(device(name)["present"]);
  }
  void expect_driving_again() {
    EXPECT_TRUE(comes_true(kPatience_s, [&] { return drive().verdict.motion == Motion::kGo && goes(); }))
        << state();
  }
  /// As far as the map goes by it, the robot is where it is.
  void expect_to_know_its_place() {
    EXPECT_TRUE(comes_true(kPatience_s, [&] {
      const auto pose = ports().world.get().value->pose;
      if (pose.lost) return false;
      for (const StampedPose& truth : hardware().world.truth_map()) {
        if (truth.stamp < pose.stamp) continue;
        const Pose2 off = truth.map_T_robot.inverse() * pose.map_T_robot;
        return off.translation().norm() < 0.05 && std::abs(off.yaw) < 0.05;
      }
      return false;
    })) << state();
  }
};

TEST_F(WholeRobotTest, StopsWithoutItsLidarAndGoesOnWhenItIsBack) {
  start_turning();
  hardware().unplug_lidar();
  expect_stop_within(config().drive.safety.scan_timeout_s, Cause::kScan);
  EXPECT_THAT(drive().verdict.reason, StartsWith("no lidar data for "));
  expect_trouble("lidar", "is it plugged in");
  const std::uint64_t samples = device("lidar")["samples"];
  hardware().plug_in_lidar();
  const auto back_s = comes_true(kPatience_s, [&] { return device("lidar")["samples"] > samples; });
  ASSERT_TRUE(back_s) << state();
  EXPECT_LE(*back_s, 3.0 + kBusy_s);
  EXPECT_EQ(trouble("lidar"), "");
  expect_driving_again();
  expect_to_know_its_place();
}

TEST_F(WholeRobotTest, SlowsDownWithoutItsImuAndKnowsItsHeadingWhenItIsBack) {
  start_turning();
  hardware().unplug_imu();
  const auto slow_s = comes_true(kPatience_s, [&] { return drive().cause == Cause::kImu; });
  ASSERT_TRUE(slow_s) << state();
  EXPECT_LE(*slow_s, config().drive.safety.imu_timeout_s + kBusy_s);
  EXPECT_EQ(drive().verdict.motion, Motion::kSlow);
  EXPECT_THAT(drive().verdict.reason, HasSubstr("tilt is not watched"));
  EXPECT_TRUE(comes_true(1.0 + kBusy_s,
                         [&] { return drive().applied.w_radps <= config().drive.safety.slow_turn_radps; }));
  EXPECT_TRUE(goes()) << state();
  expect_trouble("imu", "imu: nothing answers at 0x28 on /dev/i2c-3");
  hardware().plug_in_imu();
  expect_driving_again();
  EXPECT_EQ(trouble("imu"), "");
  expect_to_know_its_place();
}

/// Turns the wheels' encoders as the robot rolls, in a thread of its own.
class RollingWheels {
 public:
  static constexpr unsigned kLeftA = 5, kLeftB = 6, kRightA = 12, kRightB = 13;
  static constexpr double kStep_m = 0.005, kTrack_m = 0.3;

  explicit RollingWheels(EmulatedHardware& hardware)
      : hardware_(hardware), thread_([this](const std::stop_token& stop) { run(stop); }) {}

  static void configure(EncodersConfig& config) {
    config.left_a_line = kLeftA, config.left_b_line = kLeftB;
    config.right_a_line = kRightA, config.right_b_line = kRightB;
    config.right_reversed = false;
    config.metres_per_step = kStep_m, config.track_m = kTrack_m;
  }

 private:
  void run(const std::stop_token& stop) {
    Time last = hardware_.clock.now();
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      const Twist twist = hardware_.world.twist();
      const double seconds = to_seconds(hardware_.clock.now() - last);
      last = hardware_.clock.now();
      roll(kLeftA, kLeftB, left_m_, seconds * (twist.v_mps - 0.5 * kTrack_m * twist.w_radps));
      roll(kRightA, kRightB, right_m_, seconds * (twist.v_mps + 0.5 * kTrack_m * twist.w_radps));
    }
  }
  /// A leads; four steps a period: 00, 10, 11, 01.
  void roll(unsigned a, unsigned b, double& rolled_m, double more_m) {
    rolled_m += more_m;
    const auto phase = static_cast<std::int64_t>(std::floor(rolled_m / kStep_m)) & 3;
    hardware_.pins->set_wire(a, phase == 1 || phase == 2);
    hardware_.pins->set_wire(b, phase >= 2);
  }

  EmulatedHardware& hardware_;
  double left_m_ = 0.0, right_m_ = 0.0;
  std::jthread thread_;
};

TEST_F(WholeRobotTest, HearsOfItsWheelsWhereTheyHaveEncoders) {
  begin(bare_room());
  RollingWheels::configure(config().hardware.encoders);
  RollingWheels wheels(hardware());
  start();
  robot().ports().recording_wish.put({true, hardware().folder() + "/wheels.mcap"});
  drive_by([](Time, const PoseEstimate&, const Verdict&) { return Twist{0.0, 0.5}; });
  ASSERT_TRUE(comes_true(kPatience_s, [&] { return goes(); })) << state();
  ASSERT_TRUE(comes_true(kPatience_s, [&] { return device("wheels").value("samples", 0) > 100; })) << state();
  EXPECT_EQ(trouble("wheels"), "");
  EXPECT_THAT(device("wheels")["about"].get<std::string>(), StartsWith("encoders on lines 5 and 6"));
  EXPECT_THAT(device("lidar")["about"].get<std::string>(), HasSubstr("A3"));
  EXPECT_THAT(device("imu")["about"].get<std::string>(), HasSubstr("gyroscope"));
  EXPECT_THAT(device("motors")["about"].get<std::string>(), HasSubstr("failsafe on"));
  expect_to_know_its_place();
  let_go();
  hardware().unplug_pins();
  expect_trouble("wheels", "wheels");
  hardware().plug_in_pins();
  EXPECT_TRUE(comes_true(kPatience_s, [&] { return trouble("wheels").empty(); })) << state();
  EXPECT_EQ(robot().stop().trouble, "");
  robot().finish();
  const auto recording = open_recording(hardware().folder() + "/wheels.mcap");
  std::optional<OdometrySample> first, last;
  while (const auto record = recording->next()) {
    const auto* sample = std::get_if<OdometrySample>(&*record);
    if (!sample) continue;
    if (!first) first = *sample;
    last = *sample;
  }
  ASSERT_TRUE(last);
  EXPECT_GT(last->stamp - first->stamp, std::chrono::seconds(1));
  // A busy computer loses edges.
  EXPECT_GT(std::abs((first->odom_T_robot.inverse() * last->odom_T_robot).yaw), 0.05);
}

TEST_F(WholeRobotTest, SetsTheImuUpAnewWhenTheBusItselfWasGone) {
  start_turning();
  hardware().imu.fail(ENODEV, ChipFaults::kForever);
  ASSERT_TRUE(comes_true(kPatience_s, [&] { return drive().cause == Cause::kImu; })) << state();
  expect_trouble("imu", "imu: no /dev/i2c-3");
  hardware().imu.fail(0, 0);
  hardware().imu.reset();
  expect_driving_again();
  EXPECT_EQ(trouble("imu"), "");
}

TEST_F(WholeRobotTest, StopsWithoutItsMotorBoardAndSwitchesItsFailsafeOnBeforeItGoesOn) {
  start_turning();
  hardware().unplug_motors();
  expect_stop_within(config().drive.safety.motors_timeout_s, Cause::kMotorsSilent);
  expect_trouble("motors", "motors: nothing answers at 0x15 on /dev/i2c-1");
  EXPECT_FALSE(hardware().motors.failsafe_on());
  hardware().plug_in_motors();
  expect_driving_again();
  EXPECT_TRUE(hardware().motors.failsafe_on());
  EXPECT_EQ(trouble("motors"), "");
}

TEST_F(WholeRobotTest, HeedsItsEStopUntilAPersonClearsIt) {
  start_turning();
  hardware().pins->set_wire(EmulatedHardware::kEStopLine, true);
  expect_stop_within(0.02, Cause::kEStopPin);
  EXPECT_EQ(drive().verdict.motion, Motion::kEStop);
  hardware().pins->set_wire(EmulatedHardware::kEStopLine, false);
  EXPECT_FALSE(comes_true(1.0, [&] { return !is_stopped_by(Cause::kEStopPin); })) << state();
  ports().clear_asked = true;
  expect_driving_again();
}

TEST_F(WholeRobotTest, StopsWhenItsEStopCannotBeReadAnyMore) {
  start_turning();
  hardware().unplug_pins();
  expect_stop_within(config().drive.safety.pins_timeout_s, Cause::kPinsSilent);
  expect_trouble("pins", "pins: ");
  hardware().plug_in_pins();
  expect_driving_again();
  EXPECT_EQ(trouble("pins"), "");
}

TEST_F(WholeRobotTest, TellsOfAPressedBumper) {
  start_turning();
  EXPECT_EQ(drive().collision, false);
  hardware().pins->set_wire(EmulatedHardware::kBumperLine, true);
  EXPECT_TRUE(comes_true(kPatience_s, [&] { return drive().collision == true; })) << state();
  EXPECT_TRUE(comes_true(kPatience_s, [&] { return drive().cause == Cause::kTouch; })) << state();
  hardware().pins->set_wire(EmulatedHardware::kBumperLine, false);
  expect_driving_again();
}

TEST_F(WholeRobotTest, DrivesWithoutItsCamera) {
  begin(bare_room());
  config().hardware.camera.name = "auto";
  start();
  ports().watchers = 1;
  hold(kTurning);
  expect_driving_again();
  expect_trouble("camera", "is the ribbon cable in");
  EXPECT_EQ(device("camera")["samples"], 0);
  EXPECT_EQ(drive().verdict.motion, Motion::kGo) << state();
}

TEST_F(WholeRobotTest, ComesToLifeInWhateverOrderItsDevicesAreThere) {
  begin(bare_room(), EmulatedHardware::Plugged::kNothing);
  start();
  hold(kTurning);
  expect_trouble("lidar", "is it plugged in");
  expect_trouble("imu", "imu: no /dev/i2c-3");
  expect_trouble("motors", "motors: no /dev/i2c-1");
  expect_trouble("pins", "pins: there is no /dev/gpiochip");
  EXPECT_GE(drive().verdict.motion, Motion::kStop);
  const auto comes_alive = [&](const std::string& name) {
    EXPECT_TRUE(comes_true(kPatience_s,
                           [&] {
                             const nlohmann::json shown = device(name);
                             return shown.is_object() && shown["samples"] > 0 && trouble(name).empty();
                           }))
        << name << "\n"
        << state();
  };
  hardware().plug_in_pins();
  comes_alive("pins");
  hardware().plug_in_motors();
  comes_alive("motors");
  EXPECT_TRUE(comes_true(kPatience_s, [&] { return is_stopped_by(Cause::kScan); })) << state();
  hardware().plug_in_lidar();
  comes_alive("lidar");
  hardware().plug_in_imu();
  comes_alive("imu");
  expect_driving_again();
  expect_to_know_its_place();
}

}  // namespace
}  // namespace dynslam::test
