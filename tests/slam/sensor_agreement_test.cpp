// SPDX-License-Identifier: MIT
#include "slam/sensor_agreement.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dynslam {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A drive with turns both ways, as a map, an IMU and wheels tell it, each with noise.
class Drive {
 public:
  double imu_sign = 1.0, turn_sign = 1.0, way_sign = 1.0;
  SensorAgreement agreement;

  void go(int scans) {
    for (int i = 0; i < scans; ++i) {
      const double turn = 0.08 * std::sin(0.1 * step_), way = 0.04;
      ++step_;
      const auto off = [&] { return 0.005 * noise_(random_); };
      agreement.note({way + off(), off(), turn + off()}, imu_sign * turn + off(),
                     Pose2{way_sign * way + off(), off(), turn_sign * turn + off()});
    }
  }

 private:
  int step_ = 0;
  std::mt19937 random_{3};
  std::normal_distribution<double> noise_{0.0, 1.0};
};

TEST(SensorAgreement, FindsNothingWhereAllAgree) {
  Drive drive;
  drive.go(2000);
  EXPECT_THAT(drive.agreement.findings(), IsEmpty());
}

TEST(SensorAgreement, NamesAnImuThatTurnsTheOtherWay) {
  Drive drive;
  drive.imu_sign = -1;
  drive.go(10);
  EXPECT_FALSE(drive.agreement.imu_turns_backwards()) << "too early to say";
  drive.go(100);
  EXPECT_TRUE(drive.agreement.imu_turns_backwards());
  ASSERT_THAT(drive.agreement.findings(), SizeIs(1));
  EXPECT_THAT(drive.agreement.findings().front(), HasSubstr("IMU"));
}

TEST(SensorAgreement, NamesWheelsThatTurnOrDriveTheOtherWay) {
  Drive drive;
  drive.turn_sign = drive.way_sign = -1;
  drive.go(200);
  EXPECT_TRUE(drive.agreement.wheels_turn_backwards());
  EXPECT_TRUE(drive.agreement.wheels_drive_backwards());
  EXPECT_THAT(drive.agreement.findings(), SizeIs(2));
}

TEST(SensorAgreement, NamesAnImuThatHangsAlsoAfterItWentWell) {
  Drive drive;
  drive.go(500);
  drive.imu_sign = 0;
  drive.go(5);
  EXPECT_FALSE(drive.agreement.imu_hangs()) << "too early to say";
  SensorAgreement hangs = drive.agreement;
  for (int i = 0; i < 10; ++i) hangs.note({0.04, 0, 0.08}, 0.0, std::nullopt);
  ASSERT_THAT(hangs.findings(), SizeIs(1));
  EXPECT_THAT(hangs.findings().front(), HasSubstr("hangs"));
}

TEST(SensorAgreement, DoesNotBlameWheelsThatStandStill) {
  SensorAgreement agreement;
  for (int i = 0; i < 500; ++i) agreement.note({0.04, 0, 0.1}, 0.1, Pose2{});
  EXPECT_THAT(agreement.findings(), IsEmpty());
}

TEST(SensorAgreement, AsksNothingOfSensorsThatAreNotThere) {
  SensorAgreement agreement;
  for (int i = 0; i < 500; ++i) agreement.note({0.04, 0, 0.1}, std::nullopt, std::nullopt);
  EXPECT_THAT(agreement.findings(), IsEmpty());
}

}  // namespace
}  // namespace dynslam
