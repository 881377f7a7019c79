// SPDX-License-Identifier: MIT
#include "drivers/bno055/bno055.h"

#include <cerrno>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "drivers/bno055_emulator.h"
#include "drivers/mock_i2c_bus.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::ChipFaults;
using test::Garble;
using test::TrueMotion;
using ::testing::HasSubstr;

constexpr Duration kLatency = milliseconds(5);
constexpr int kRate_hz = 50;
constexpr std::size_t kASecond = kRate_hz;  ///< of samples

class Bno055Test : public ::testing::Test {
 protected:
  Bno055Test() {
    buses_.add_bus(3);
    buses_.plug(3, 0x28, &chip_);
    config_.rate_hz = kRate_hz;
  }

  Bno055& imu() {
    if (!imu_) imu_ = std::make_unique<Bno055>(config_, clock_, store_);
    return *imu_;
  }
  /// Lets time pass, asking all the while as a robot does; what the IMU complained of is in trouble_.
  std::vector<ImuSample> run(Duration time) {
    std::vector<ImuSample> samples;
    for (const Time end = clock_.now() + time; clock_.now() < end;
         clock_.set(clock_.now() + milliseconds(1))) {
      try {
        if (const auto sample = imu().next(clock_.now())) samples.push_back(*sample);
      } catch (const DeviceError& e) {
        trouble_ = e.what();
      }
    }
    return samples;
  }
  TrueMotion feel() {
    if (feels_) return feels_();
    return {Eigen::Quaterniond(Eigen::AngleAxisd(true_yaw_at(clock_.now()), Eigen::Vector3d::UnitZ())),
            {0, 0, yaw_radps_}};
  }
  double true_yaw_at(Time t) const { return yaw_ + yaw_radps_ * to_seconds(t - turns_since_); }
  /// From now on.
  void turn_at(double radps) {
    yaw_ = true_yaw_at(clock_.now());
    turns_since_ = clock_.now();
    yaw_radps_ = radps;
  }
  std::uint64_t count(const char* what) { return imu().counters()[what]; }

  SteppedClock clock_{time_at_s(1)};
  double yaw_ = 0.0, yaw_radps_ = 0.0;
  Time turns_since_ = clock_.now();
  std::function<TrueMotion()> feels_;
  test::Bno055Emulator chip_{[this] { return clock_.now(); }, [this] { return feel(); }};
  test::MockI2cBuses buses_;
  Bno055Config config_;
  ProfileStore store_;
  std::unique_ptr<Bno055> imu_;
  std::string trouble_;
};

TEST_F(Bno055Test, SpeaksASecondAfterItsStart) {
  EXPECT_TRUE(run(milliseconds(600)).empty());
  EXPECT_FALSE(run(milliseconds(600)).empty());
  EXPECT_EQ(trouble_, "");
  EXPECT_EQ(chip_.mode(), 8);
}

TEST_F(Bno055Test, GivesAHundredSamplesASecondOnAGrid) {
  config_.rate_hz = 0;
  run(seconds(2));
  const auto samples = run(seconds(1));
  ASSERT_EQ(samples.size(), 100U);
  for (std::size_t i = 1; i < samples.size(); ++i)
    EXPECT_EQ(samples[i].stamp - samples[i - 1].stamp, milliseconds(10));
  EXPECT_LT(samples.back().stamp, clock_.now());
}

TEST_F(Bno055Test, GivesFiftyOnASoftwareBus) {
  buses_.add_bus(4, true);
  buses_.plug(4, 0x28, &chip_);
  config_.bus = "/dev/i2c-4";
  config_.rate_hz = 0;
  run(seconds(2));
  EXPECT_EQ(run(seconds(1)).size(), 50U);
  EXPECT_TRUE(imu().report().on_software_bus);
}

TEST_F(Bno055Test, GivesAsManyAsItIsTold) {
  config_.rate_hz = 25;
  run(seconds(2));
  EXPECT_EQ(run(seconds(1)).size(), 25U);
}

TEST_F(Bno055Test, TellsHowTheRobotTurns) {
  yaw_ = 2;
  turn_at(1.5);
  const auto samples = run(seconds(4));
  ASSERT_GT(samples.size(), 2 * kASecond);
  const auto off = [&](const ImuSample& s) {
    return wrap_angle(yaw_of(s.world_q_robot) - true_yaw_at(s.stamp + kLatency));
  };
  for (const ImuSample& s : samples) EXPECT_NEAR(wrap_angle(off(s) - off(samples[0])), 0.0, 1e-3);
  EXPECT_NEAR(imu().report().motion.rate_radps.z(), 1.5, 0.01);
}

TEST_F(Bno055Test, TellsRollAndPitch) {
  const Eigen::Quaterniond tilted = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitX());
  feels_ = [&] { return TrueMotion{tilted, {}}; };
  const auto samples = run(seconds(2));
  ASSERT_FALSE(samples.empty());
  const Eigen::Quaterniond level(Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitZ()));
  EXPECT_LT(samples.back().world_q_robot.angularDistance(level * tilted), 1e-3) << "the heading begins at 0";
}

TEST_F(Bno055Test, SpeaksOfTheRobotsAxesHoweverItIsMounted) {
  const std::vector<std::pair<std::string, Eigen::Vector3d>> axes = {{"x", {1, 0, 0}}, {"-x", {-1, 0, 0}},
                                                                     {"y", {0, 1, 0}}, {"-y", {0, -1, 0}},
                                                                     {"z", {0, 0, 1}}, {"-z", {0, 0, -1}}};
  const Eigen::Quaterniond nose_down(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()));
  feels_ = [&] { return TrueMotion{nose_down, {0, 0, 0.5}}; };
  int mounts = 0;
  for (const auto& [forward_name, forward] : axes) {
    for (const auto& [up_name, up] : axes) {
      if (forward.dot(up) != 0) continue;
      ++mounts;
      Eigen::Matrix3d robot_R_chip;  // its rows are the robot's axes in the chip's
      robot_R_chip << forward.transpose(), up.cross(forward).transpose(), up.transpose();
      chip_.set_mount(Eigen::Quaterniond(robot_R_chip));
      config_.forward = forward_name;
      config_.up = up_name;
      config_.rate_hz = 10;
      imu_.reset();
      const auto samples = run(milliseconds(1500));
      ASSERT_FALSE(samples.empty()) << forward_name << ' ' << up_name << ": " << trouble_;
      EXPECT_LT(samples.back().world_q_robot.angularDistance(nose_down), 1e-3)
          << forward_name << ' ' << up_name;
      EXPECT_NEAR(imu().report().motion.rate_radps.z(), 0.5, 0.01);
    }
  }
  EXPECT_EQ(mounts, 24);
}

TEST_F(Bno055Test, DropsLoneGarbledReadings) {
  run(seconds(2));
  for (const Garble how : {Garble::kZeros, Garble::kOnes, Garble::kSwapped, Garble::kTopBit}) {
    chip_.garble(how, 1);
    for (const ImuSample& s : run(milliseconds(500)))
      EXPECT_NEAR(yaw_of(s.world_q_robot), 0.0, 1e-3) << static_cast<int>(how);
  }
  EXPECT_EQ(trouble_, "");
  EXPECT_EQ(count("all-zero") + count("status"), 1U);
  EXPECT_EQ(chip_.resets(), 1);
}

TEST_F(Bno055Test, DropsLoneJumps) {
  turn_at(0.5);
  run(seconds(2));
  chip_.kick(0.5, 1);
  EXPECT_EQ(run(seconds(1)).size(), kASecond - 1);
  EXPECT_EQ(count("jump"), 1U);
}

TEST_F(Bno055Test, PutsUpWithSomeMissingAcknowledgements) {
  run(seconds(2));
  for (const int error : {EREMOTEIO, ENXIO, EIO}) {
    chip_.fail(error, 2);
    EXPECT_EQ(run(seconds(1)).size(), kASecond) << error;
  }
  EXPECT_EQ(count("retries"), 6U);
  chip_.fail(ETIMEDOUT, 1);
  EXPECT_GE(run(seconds(1)).size(), kASecond - 1);
  EXPECT_EQ(trouble_, "");
}

TEST_F(Bno055Test, ResetsAChipThatTalksNonsense) {
  for (const Garble how : {Garble::kZeros, Garble::kOnes, Garble::kSwapped, Garble::kTopBit}) {
    run(seconds(2));
    trouble_.clear();
    chip_.garble(how, 5);
    run(milliseconds(100));
    EXPECT_THAT(trouble_, HasSubstr("made no sense")) << static_cast<int>(how);
    EXPECT_FALSE(imu().report().running);
    EXPECT_GT(run(seconds(2)).size(), kASecond / 2);
  }
  EXPECT_EQ(chip_.resets(), 5);
}

TEST_F(Bno055Test, ResetsAChipThatStandsStillForEver) {
  run(seconds(2));
  chip_.freeze();
  run(seconds(4));
  EXPECT_THAT(trouble_, HasSubstr("same for ever"));
  EXPECT_EQ(count("frozen"), 1U);
  EXPECT_EQ(run(seconds(2)).size(), 2 * kASecond);
}

TEST_F(Bno055Test, LetsARobotStandStill) {
  EXPECT_GT(run(seconds(10)).size(), 8 * kASecond);
  EXPECT_EQ(trouble_, "");
}

TEST_F(Bno055Test, GoesOnWithItsHeadingAfterTheChipWasReset) {
  turn_at(0.3);
  const double before = yaw_of(run(seconds(3)).back().world_q_robot);
  turn_at(0.0);
  yaw_ = 0.7;
  chip_.reset();
  run(seconds(2));
  EXPECT_THAT(trouble_, HasSubstr("nothing answers")) << "for 0.65 s";
  const auto after = run(seconds(1));
  ASSERT_EQ(after.size(), kASecond);
  EXPECT_NEAR(wrap_angle(yaw_of(after.front().world_q_robot) - before), 0.0, 1e-3);
  EXPECT_EQ(chip_.mode(), 8);
}

TEST_F(Bno055Test, NeedNotBeThereAtTheStart) {
  buses_.plug(3, 0x28, nullptr);
  EXPECT_TRUE(run(seconds(1)).empty());
  EXPECT_THAT(trouble_, HasSubstr("imu: nothing answers at 0x28 on /dev/i2c-3"));
  buses_.plug(3, 0x28, &chip_);
  EXPECT_GT(run(seconds(2)).size(), kASecond / 2);
}

TEST_F(Bno055Test, ComesBackAfterItWasPulled) {
  run(seconds(2));
  buses_.plug(3, 0x28, nullptr);
  EXPECT_LE(run(seconds(1)).size(), 1U);
  chip_.reset();
  buses_.plug(3, 0x28, &chip_);
  EXPECT_GT(run(seconds(3)).size(), kASecond);
}

TEST_F(Bno055Test, IsNeverHeldUpLongerThanItIsAskedTo) {
  const Time asked = clock_.now();
  EXPECT_FALSE(imu().next(asked));
  EXPECT_FALSE(imu().next(asked)) << "the chip is being reset meanwhile";
  EXPECT_EQ(chip_.resets(), 1);
}

TEST_F(Bno055Test, DropsASampleThatCameTooLateToKnowItsTime) {
  run(seconds(2));
  bool once = true;
  feels_ = [&] {
    if (std::exchange(once, false)) clock_.set(clock_.now() + milliseconds(30));
    return TrueMotion{};
  };
  const auto samples = run(seconds(1));
  EXPECT_EQ(count("late"), 1U);
  for (std::size_t i = 1; i < samples.size(); ++i)
    EXPECT_EQ((samples[i].stamp - samples[0].stamp) % milliseconds(20), Duration(0));
}

TEST_F(Bno055Test, GetsAlongWithASlowBus) {
  // 23 bytes at 10 kHz, which is how some get past a controller that cannot wait for the chip.
  feels_ = [&] {
    clock_.set(clock_.now() + milliseconds(21));
    return TrueMotion{};
  };
  run(seconds(2));
  EXPECT_GT(run(seconds(1)).size(), 15U);
  EXPECT_EQ(count("late"), 0U);
  EXPECT_EQ(trouble_, "");
}

TEST_F(Bno055Test, TellsWithItsFirstSampleHowItIs) {
  chip_.set_calibration(1, 3, 2, 0);
  for (int ms = 0; ms < 3000 && !imu().next(clock_.now()); ++ms) clock_.set(clock_.now() + milliseconds(1));
  EXPECT_EQ(imu().report().status.temperature_c, 25);
  EXPECT_EQ(imu().report().status.calibration.gyroscope, 3);
}

TEST_F(Bno055Test, RefusesWhatIsNoBno055) {
  chip_.set_chip(0x42);
  EXPECT_TRUE(run(seconds(1)).empty());
  EXPECT_THAT(trouble_, HasSubstr("no BNO055"));
}

TEST_F(Bno055Test, DoesNotBelieveATemperatureThatLeaps) {
  run(seconds(2));
  chip_.set_temperature_c(60);
  run(seconds(2));
  EXPECT_GE(count("status"), 3U);
  EXPECT_THAT(trouble_, HasSubstr("does not measure any more"));
}

TEST_F(Bno055Test, ReportsWhatItIs) {
  chip_.set_calibration(1, 3, 2, 0);
  run(seconds(3));
  const Bno055Report report = imu().report();
  EXPECT_TRUE(report.running);
  EXPECT_TRUE(report.identity.is_usual());
  EXPECT_EQ(report.identity.software, 0x0311);
  EXPECT_EQ(report.status.temperature_c, 25);
  EXPECT_EQ(report.status.calibration.gyroscope, 3);
  EXPECT_EQ(report.status.calibration.accelerometer, 2);
  EXPECT_FALSE(report.has_profile);
}

TEST_F(Bno055Test, UsesTheCompassWhenToldTo) {
  config_.use_compass = true;
  yaw_ = 1;
  const auto samples = run(seconds(2));
  ASSERT_FALSE(samples.empty());
  EXPECT_EQ(chip_.mode(), 12);
  EXPECT_NEAR(yaw_of(samples.back().world_q_robot), 1, 1e-3);
}

class Bno055ProfileTest : public Bno055Test {
 protected:
  Bno055ProfileTest() {
    store_.load = [this] { return file_; };
    store_.save = [this](const std::string& text) {
      if (disk_full_) throw std::runtime_error("disk full");
      file_ = text;
      ++saved_;
    };
  }
  std::optional<std::string> file_;
  bool disk_full_ = false;
  int saved_ = 0;
  const bno055::Profile profile_{0xec, 0xff, 0xa5, 0x00, 0xe8, 0xff, 0x4d};
};

TEST_F(Bno055ProfileTest, IsKeptOnceTheChipIsCalibratedAndTheRobotStands) {
  run(seconds(2));
  chip_.set_profile(profile_);
  run(seconds(2));
  EXPECT_EQ(saved_, 0) << "nothing is calibrated yet";
  turn_at(0.5);
  chip_.set_calibration(3, 3, 3, 0);
  run(seconds(3));
  EXPECT_EQ(saved_, 0) << "the robot turns";
  turn_at(0.0);
  const auto samples = run(seconds(5));
  EXPECT_EQ(saved_, 1);
  EXPECT_EQ(bno055::read_profile(file_.value()), profile_);
  EXPECT_GT(samples.size(), 4 * kASecond) << "a short gap";
  EXPECT_EQ(chip_.resets(), 1);
  EXPECT_EQ(trouble_, "");
  EXPECT_TRUE(imu().report().has_profile);
}

TEST_F(Bno055ProfileTest, KeepsTheHeadingWhileItIsRead) {
  chip_.set_calibration(3, 3, 3, 3);
  yaw_ = 1;
  const auto samples = run(seconds(6));
  EXPECT_EQ(saved_, 1);
  for (const ImuSample& s : samples) EXPECT_NEAR(yaw_of(s.world_q_robot), 0.0, 1e-3);
}

TEST_F(Bno055ProfileTest, IsGivenToTheChipAtTheNextStart) {
  file_ = bno055::profile_text(profile_);
  run(seconds(2));
  EXPECT_EQ(chip_.profile(), profile_);
  EXPECT_TRUE(imu().report().has_profile);
  chip_.reset();
  run(seconds(3));
  EXPECT_EQ(chip_.profile(), profile_) << "and after each reset";
  chip_.set_calibration(3, 3, 3, 3);
  run(seconds(4));
  EXPECT_EQ(saved_, 0) << "it is there already";
}

TEST_F(Bno055ProfileTest, ThatIsSpoiltIsNotGivenToTheChip) {
  file_ = bno055::profile_text(profile_);
  (*file_)[12] = '0';
  run(seconds(2));
  EXPECT_EQ(chip_.profile(), bno055::Profile{});
  EXPECT_EQ(count("profile-bad"), 1U);
}

TEST_F(Bno055ProfileTest, ThatCannotBeSavedIsNoTrouble) {
  disk_full_ = true;
  chip_.set_calibration(3, 3, 3, 3);
  EXPECT_GT(run(seconds(6)).size(), 4 * kASecond);
  EXPECT_EQ(count("profile-unsaved"), 1U);
  EXPECT_EQ(trouble_, "");
}

}  // namespace
}  // namespace dynslam
