// SPDX-License-Identifier: MIT
// The driver against an emulated lidar, over a pseudo-terminal and in real time.
#include "drivers/rplidar/rplidar.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "device/device_error.h"
#include "tests/drivers/rplidar_emulator.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::EmulatedLidar;
using test::RplidarEmulator;
using testing::HasSubstr;

/// Farther and farther counter-clockwise, and pushed about a little, as real ranges are never twice the same.
double room_m(double angle_rad, Time t) {
  return 3.0 + 0.5 * angle_rad + 0.02 * std::sin(40.0 * seconds_of(t));
}

class RplidarTest : public testing::Test {
 protected:
  RplidarTest() {
    std::string name = testing::TempDir() + "/rplidarXXXXXX";
    folder_ = mkdtemp(name.data());
    config_.port_folder = folder_;
  }
  ~RplidarTest() override { std::filesystem::remove_all(folder_); }

  void plug_in(const EmulatedLidar& kind, RplidarEmulator::Ranger ranger = room_m) {
    emulator_ = std::make_unique<RplidarEmulator>(kind, clock_, folder_, std::move(ranger));
  }
  /// As the lidar's thread does it: in short waits, and again half a second after an error.
  std::optional<Scan> scan_within(Rplidar& lidar, Duration length) {
    const Time end = clock_.now() + length;
    while (clock_.now() < end) {
      try {
        const Time until = std::min(end, clock_.now() + milliseconds(200));
        if (auto scan = lidar.next(until)) return scan;
        EXPECT_LT(clock_.now(), until + milliseconds(200)) << "waited too long";
      } catch (const DeviceError& e) {
        errors_.push_back(e.what());
        std::this_thread::sleep_for(milliseconds(500));
      }
    }
    return std::nullopt;
  }
  void expect_error(Rplidar& lidar, const std::string& words, Duration within = seconds(8)) {
    const Time end = clock_.now() + within;
    try {
      while (clock_.now() < end) lidar.next(clock_.now() + milliseconds(200));
      ADD_FAILURE() << "no error";
    } catch (const DeviceError& e) {
      EXPECT_THAT(e.what(), HasSubstr(words));
    }
  }
  bool comes_true(const std::function<bool()>& what) {
    for (int i = 0; i < 2000 && !what(); ++i) std::this_thread::sleep_for(milliseconds(1));
    return what();
  }

  RunningClock clock_;
  std::string folder_;
  RplidarConfig config_;
  std::unique_ptr<RplidarEmulator> emulator_;
  std::vector<std::string> errors_;
};

struct Model {
  EmulatedLidar kind;
  std::string name, mode;
  std::size_t beams;
};
class RplidarModels : public RplidarTest, public testing::WithParamInterface<Model> {};
void PrintTo(const Model& model, std::ostream* out) { *out << model.name; }
INSTANTIATE_TEST_SUITE_P(All, RplidarModels,
                         testing::Values(Model{test::emulated_a1(), "A1M8", "Express", 420},
                                         Model{test::emulated_a1_new(), "A1M8", "Boost", 787},
                                         Model{test::emulated_a2(), "A2M8", "Express", 400},
                                         Model{test::emulated_a3(), "A3M1", "Sensitivity", 1590},
                                         Model{test::emulated_s1(), "S1M1", "DenseBoost", 920},
                                         Model{test::emulated_c1(), "C1M1", "DenseBoost", 500}));

TEST_P(RplidarModels, MeasureTheRoomInTheBestMode) {
  plug_in(GetParam().kind);
  Rplidar lidar(config_, {}, clock_);
  ASSERT_TRUE(scan_within(lidar, seconds(6)));
  const auto scan = scan_within(lidar, seconds(2));
  ASSERT_TRUE(scan);
  EXPECT_NEAR(static_cast<double>(scan->beams.size()), static_cast<double>(GetParam().beams), 6.0);
  std::size_t wrong = 0;
  for (const Beam& b : scan->beams) {
    const double angle = wrap_angle(b.angle_rad);
    if (std::abs(angle) > 3.1) continue;  // where the room has its step
    wrong += std::abs(b.range_m - (3.0 + 0.5 * angle)) > 0.035 ? 1 : 0;
  }
  EXPECT_LE(wrong, scan->beams.size() / 100);
  const RplidarReport report = lidar.report();
  EXPECT_EQ(report.device.info->model_name(), GetParam().name);
  EXPECT_EQ(report.device.mode->name, GetParam().mode);
  EXPECT_EQ(report.device.baud, GetParam().kind.baud);
  // A busy computer is late now and then.
  for (int i = 0; i < 10 && std::abs(lidar.report().turns_per_s - 10.0) > 0.5; ++i)
    scan_within(lidar, seconds(1));
  EXPECT_NEAR(lidar.report().turns_per_s, 10.0, 0.5);
  EXPECT_TRUE(errors_.empty()) << errors_.front();
}

TEST_F(RplidarTest, TellsForAProbeWhatIsThereWithoutStartingTheMotor) {
  plug_in(test::emulated_a3());
  Rplidar lidar(config_, {}, clock_);
  while (!lidar.identify(clock_.now() + milliseconds(50))) {
  }
  const auto device = lidar.report().device;
  EXPECT_EQ(device.port, emulator_->port());
  EXPECT_EQ(device.info->firmware(), "1.29");
  EXPECT_EQ(device.info->serial.substr(0, 6), "C0C1C2");
  EXPECT_EQ(in_words(*device.health), "fine");
  ASSERT_EQ(device.modes.size(), 5U) << "one of the six cannot be decoded";
  EXPECT_EQ(device.modes[4].name, "Stability");
  EXPECT_EQ(device.modes[4].sample_us, 100.0);
  EXPECT_EQ(device.modes[4].max_range_m, 25.0);
  EXPECT_EQ(device.mode->name, "Sensitivity");
  EXPECT_FALSE(emulator_->turns());
}

TEST_F(RplidarTest, StopsAMotorThatACrashedProgramLeftTurningEvenWhenOnlyAsked) {
  plug_in(test::emulated_s1());
  {
    rplidar::DeviceTalk crashed(clock_);
    crashed.open(emulator_->port(), 256000);
    crashed.say(rplidar::motor_request(rplidar::Command::kMotorRpm, 600));
    ASSERT_TRUE(comes_true([&] { return emulator_->turns(); }));
  }
  {
    Rplidar lidar(config_, {}, clock_);
    while (!lidar.identify(clock_.now() + milliseconds(50))) {
    }
  }
  EXPECT_TRUE(comes_true([&] { return !emulator_->turns(); }));
}

TEST_F(RplidarTest, MeasuresInTheModeThatIsAskedFor) {
  for (const char* mode : {"Standard", "express", "Stability"}) {
    plug_in(test::emulated_a3());
    config_.mode = mode;
    Rplidar lidar(config_, {}, clock_);
    EXPECT_TRUE(scan_within(lidar, seconds(5))) << mode;
    EXPECT_TRUE(errors_.empty());
    emulator_.reset();
  }
  plug_in(test::emulated_a3());
  config_.mode = "Turbo";
  Rplidar lidar(config_, {}, clock_);
  expect_error(lidar, "no mode 'Turbo' but Standard, Express, Boost, Sensitivity, Stability");
}

TEST_F(RplidarTest, StartsInUnderTwoSecondsAndStopsTheMotorAtTheEnd) {
  plug_in(test::emulated_a3());
  {
    const Time begin = clock_.now();
    Rplidar lidar(config_, {}, clock_);
    ASSERT_TRUE(scan_within(lidar, seconds(5)));
    EXPECT_LT(clock_.now() - begin, seconds(2));
    EXPECT_TRUE(emulator_->turns());
  }
  EXPECT_TRUE(comes_true([&] { return !emulator_->turns() && !emulator_->measures(); }));
}

TEST_F(RplidarTest, KnowsWhenEachBeamWasTaken) {
  // All around it is as far as it is late: 1 m at full seconds, 2 m half a second after.
  const auto ranger = [](double, Time t) { return 1.0 + std::abs(std::remainder(2.0 * seconds_of(t), 2.0)); };
  plug_in(test::emulated_a3(), ranger);
  Rplidar lidar(config_, {}, clock_);
  ASSERT_TRUE(scan_within(lidar, seconds(5)));
  std::vector<double> off_s;
  for (int i = 0; i < 8; ++i) {
    const auto scan = scan_within(lidar, seconds(2));
    ASSERT_TRUE(scan);
    EXPECT_GE(clock_.now(), scan->stamp + from_seconds(scan->beams.back().time_s));
    for (const Beam& b : scan->beams) {
      if (!is_return(b)) continue;
      const double expected = ranger(0.0, scan->stamp + from_seconds(b.time_s));
      off_s.push_back(std::abs(b.range_m - expected) / 2.0);
    }
  }
  // What a busy computer sends late counts as late: only the better beams tell.
  const auto quarter = off_s.begin() + static_cast<std::ptrdiff_t>(off_s.size() / 4);
  std::nth_element(off_s.begin(), quarter, off_s.end());
  EXPECT_LT(*quarter, 0.005) << "the oldest beam of a packet is 12 ms old when it comes, the newest 6";
}

TEST_F(RplidarTest, NeverWaitsLongerThanItIsAllowedTo) {
  plug_in(test::emulated_a3());
  Rplidar lidar(config_, {}, clock_);
  int scans = 0;
  std::vector<double> late_s;
  while (scans < 3 && clock_.now() < Time(seconds(8))) {
    const Time until = clock_.now() + milliseconds(3);
    scans += lidar.next(until) ? 1 : 0;
    late_s.push_back(to_seconds(clock_.now() - until));
  }
  EXPECT_EQ(scans, 3);
  std::sort(late_s.begin(), late_s.end());
  EXPECT_LT(late_s[late_s.size() * 9 / 10], 0.01);
}

TEST_F(RplidarTest, GoesOnAfterLostAndDamagedBytes) {
  plug_in(test::emulated_a3());
  Rplidar lidar(config_, {}, clock_);
  ASSERT_TRUE(scan_within(lidar, seconds(5)));
  for (int i = 0; i < 3; ++i) {
    emulator_->drop_byte();
    emulator_->flip_bit();
    ASSERT_TRUE(comes_true([&] { return emulator_->faults_done() == 2 * (i + 1); }));
    for (int k = 0; k < 3; ++k) {
      const auto scan = scan_within(lidar, seconds(1));
      ASSERT_TRUE(scan);
      std::size_t wrong = 0;
      for (const Beam& b : scan->beams) {
        const double angle = wrap_angle(b.angle_rad);
        wrong += std::abs(angle) < 3.1 && std::abs(b.range_m - (3.0 + 0.5 * angle)) > 0.035 ? 1 : 0;
      }
      EXPECT_LE(wrong, scan->beams.size() / 100);
    }
  }
  EXPECT_TRUE(errors_.empty());
  EXPECT_GE(lidar.report().line.bad_checksums, 3U);
  EXPECT_GE(lidar.report().holed_turns, 1U);
}

TEST_F(RplidarTest, FindsItsWayIntoAStreamThatBeginsInDisorder) {
  plug_in(test::emulated_a3());
  emulator_->begin_untidily();
  Rplidar lidar(config_, {}, clock_);
  EXPECT_TRUE(scan_within(lidar, seconds(4)));
  EXPECT_TRUE(errors_.empty());
}

TEST_F(RplidarTest, TakesOverALidarThatACrashedProgramLeftMeasuring) {
  plug_in(test::emulated_a3());
  {
    rplidar::DeviceTalk crashed(clock_);
    crashed.open(emulator_->port(), 256000);
    crashed.say(rplidar::motor_request(rplidar::Command::kMotorPwm, 660));
    crashed.say(rplidar::express_request(1));
    ASSERT_TRUE(comes_true([&] { return emulator_->measures(); }));
    std::this_thread::sleep_for(milliseconds(700));
  }
  EXPECT_TRUE(emulator_->measures());
  Rplidar lidar(config_, {}, clock_);
  EXPECT_TRUE(scan_within(lidar, seconds(4)));
  EXPECT_TRUE(errors_.empty());
}

TEST_F(RplidarTest, WaitsForAMotorThatStartsSlowly) {
  plug_in(test::emulated_a3());
  emulator_->set_spin_up(seconds(4));
  Rplidar lidar(config_, {}, clock_);
  EXPECT_TRUE(scan_within(lidar, seconds(7)));
  EXPECT_TRUE(errors_.empty());
}

TEST_F(RplidarTest, SaysThatTheHeadDoesNotTurnAndComesBack) {
  plug_in(test::emulated_a3());
  Rplidar lidar(config_, {}, clock_);
  ASSERT_TRUE(scan_within(lidar, seconds(5)));
  emulator_->be_silent(true);
  expect_error(lidar, "no measurements: does its head turn?", seconds(3));
  emulator_->be_silent(false);
  EXPECT_TRUE(scan_within(lidar, seconds(3)));
}

TEST_F(RplidarTest, ResetsALidarThatStoppedToProtectItself) {
  plug_in(test::emulated_a3());
  Rplidar lidar(config_, {}, clock_);
  ASSERT_TRUE(scan_within(lidar, seconds(5)));
  emulator_->stop_to_protect(false);
  EXPECT_TRUE(comes_true([&] { return !emulator_->measures(); }));
  while (scan_within(lidar, milliseconds(100))) {
  }
  EXPECT_TRUE(scan_within(lidar, seconds(6)));
  EXPECT_EQ(emulator_->resets(), 1);
}

TEST_F(RplidarTest, SaysSoWhenALidarStaysInProtectionStop) {
  plug_in(test::emulated_a3());
  emulator_->stop_to_protect(true);
  Rplidar lidar(config_, {}, clock_);
  expect_error(lidar, "stopped to protect itself (code 8002)");
}

TEST_F(RplidarTest, ComesBackWithinThreeSecondsAfterItWasPluggedInAgain) {
  plug_in(test::emulated_a3());
  Rplidar lidar(config_, {}, clock_);
  ASSERT_TRUE(scan_within(lidar, seconds(5)));
  emulator_->unplug();
  expect_error(lidar, "unplugged?", seconds(1));
  expect_error(lidar, "no USB adapter in " + folder_ + ": is it plugged in?", seconds(1));
  emulator_->plug_in();
  const Time begin = clock_.now();
  EXPECT_TRUE(scan_within(lidar, seconds(6)));
  EXPECT_LT(clock_.now() - begin, seconds(3));
}

TEST_F(RplidarTest, SaysWhatIsWrongWithThePort) {
  config_.port = folder_ + "/ttyUSB0";
  Rplidar missing(config_, {}, clock_);
  expect_error(missing, "lidar: no " + config_.port + ": is it plugged in?", seconds(1));
  std::ofstream(config_.port) << "no port";
  Rplidar file(config_, {}, clock_);
  expect_error(file, "is no serial port", seconds(1));
}

TEST_F(RplidarTest, SaysSoWhenNothingAnswers) {
  EmulatedLidar other = test::emulated_a3();
  other.baud = 9600;
  plug_in(other);
  config_.port = emulator_->port();
  Rplidar lidar(config_, {}, clock_);
  expect_error(lidar, "no answer at 256000, 115200, 460800, 1000000 baud: is it a lidar", seconds(8));
}

}  // namespace
}  // namespace dynslam
