// SPDX-License-Identifier: MIT
#include "tools/jitter/jittered_recording.h"

#include <gtest/gtest.h>

#include "io/read_all.h"
#include "support_matchers.h"
#include "tools/jitter/made_recording.h"

namespace dynslam::jitter {
namespace {

using test::Contents;

constexpr JitterConfig kNone{0.0, 0.0, 0.0, false, false};
constexpr int kMany = 4000;
const Pose2 kStep{0.1, 0.02, 0.05};

/// Ten times a second: odometry that goes on by kStep, the IMU, a scan.
std::vector<Record> drive(int scans) {
  std::vector<Record> records;
  Pose2 odom_T_robot{3, 4, 1};
  for (int i = 0; i < scans; ++i) {
    const Time t = time_at_s(1000 + 0.1 * i);
    const Eigen::AngleAxisd yaw(0.01 * i, Eigen::Vector3d::UnitZ()), roll(0.1, Eigen::Vector3d::UnitX());
    records.emplace_back(OdometrySample{t, odom_T_robot});
    records.emplace_back(ImuSample{t, Eigen::Quaterniond(yaw * roll)});
    records.emplace_back(Scan{t, {}, {}});
    odom_T_robot = odom_T_robot * kStep;
  }
  return records;
}

Contents jittered(const JitterConfig& config, std::uint64_t seed = 1, int scans = kMany) {
  JitteredRecording recording(std::make_unique<MadeRecording>(drive(scans)), config, seed);
  return test::read_all(recording);
}

std::vector<Time> stamps(const std::vector<Scan>& scans) {
  std::vector<Time> found;
  for (const Scan& scan : scans) found.push_back(scan.stamp);
  return found;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double deviation(std::vector<double> values) {
  const double middle = mean(values);
  for (double& v : values) v = (v - middle) * (v - middle);
  return std::sqrt(mean(values));
}

TEST(JitteredRecording, LeavesAllAsItIsWhenAllIsOff) {
  const Contents plain = jittered(kNone);
  ASSERT_EQ(plain.records.size(), 3U * kMany);
  EXPECT_EQ(plain.odometry[7].odom_T_robot, std::get<OdometrySample>(drive(8)[21]).odom_T_robot);
  EXPECT_EQ(yaw_of(plain.imu[7].world_q_robot), yaw_of(std::get<ImuSample>(drive(8)[22]).world_q_robot));
}

TEST(JitteredRecording, DropsTheShareOfScansAndNothingElse) {
  JitterConfig config = kNone;
  config.drop_share = 0.05;
  const Contents some = jittered(config);
  EXPECT_NEAR(static_cast<double>(some.scans.size()) / kMany, 0.95, 0.012);
  EXPECT_EQ(some.imu.size(), std::size_t{kMany});
  EXPECT_EQ(some.odometry.size(), std::size_t{kMany});
  config.drop_share = 1.0;
  EXPECT_TRUE(jittered(config).scans.empty());
}

TEST(JitteredRecording, IsTheSameForTheSameSeedOnly) {
  const Contents a = jittered({}, 7), b = jittered({}, 7), other = jittered({}, 8);
  EXPECT_EQ(stamps(a.scans), stamps(b.scans));
  EXPECT_NE(stamps(a.scans), stamps(other.scans));
  EXPECT_EQ(a.odometry.back().odom_T_robot, b.odometry.back().odom_T_robot);
  EXPECT_NE(a.odometry.back().odom_T_robot, other.odometry.back().odom_T_robot);
  EXPECT_EQ(yaw_of(a.imu[0].world_q_robot), yaw_of(b.imu[0].world_q_robot));
  EXPECT_NE(yaw_of(a.imu[0].world_q_robot), yaw_of(other.imu[0].world_q_robot));
}

TEST(JitteredRecording, DropsTheSameScansWithTheOtherKindsOff) {
  JitterConfig config = kNone;
  config.drop_share = JitterConfig{}.drop_share;
  config.cut_s = JitterConfig{}.cut_s;
  EXPECT_EQ(stamps(jittered(config).scans), stamps(jittered({}).scans));
}

TEST(JitteredRecording, CutsTheBeginningOfEverySensor) {
  JitterConfig config = kNone;
  config.cut_s = 2.95;
  const Contents rest = jittered(config, 1, 100);
  ASSERT_EQ(rest.records.size(), 3U * 70U);
  EXPECT_EQ(rest.scans.front().stamp, time_at_s(1003));
  EXPECT_EQ(rest.imu.front().stamp, time_at_s(1003));
  EXPECT_EQ(rest.odometry.front().stamp, time_at_s(1003));
}

TEST(JitteredRecording, CountsTheCutFromTheFirstScan) {
  std::vector<Record> records = {OdometrySample{time_at_s(1), {}}, OdometrySample{time_at_s(9), {}}};
  for (const double t_s : {10.0, 12.0, 14.0}) records.emplace_back(Scan{time_at_s(t_s), {}, {}});
  JitterConfig config = kNone;
  config.cut_s = 3.0;
  JitteredRecording recording(std::make_unique<MadeRecording>(records), config, 1);
  const Contents rest = test::read_all(recording);
  EXPECT_EQ(stamps(rest.scans), std::vector<Time>{time_at_s(14)});
  EXPECT_TRUE(rest.odometry.empty());
}

TEST(JitteredRecording, CutsNothingMoreWhenTheClockIsSetBack) {
  std::vector<Record> records;
  for (const double t_s : {10.0, 12.0, 14.0, 5.0, 11.0}) records.emplace_back(Scan{time_at_s(t_s), {}, {}});
  JitterConfig config = kNone;
  config.cut_s = 3.0;
  JitteredRecording recording(std::make_unique<MadeRecording>(records), config, 1);
  EXPECT_EQ(stamps(test::read_all(recording).scans),
            (std::vector<Time>{time_at_s(14), time_at_s(5), time_at_s(11)}));
}

TEST(JitteredRecording, MovesTheOriginOfTheOdometryAsAWhole) {
  JitterConfig config = kNone;
  config.move_odometry = true;
  const std::vector<OdometrySample> moved = jittered(config).odometry, plain = jittered(kNone).odometry;
  const Pose2 moved_T_odom = moved[0].odom_T_robot * plain[0].odom_T_robot.inverse();
  EXPECT_GT(moved_T_odom.translation().norm(), 1.0);
  EXPECT_GT(std::abs(moved_T_odom.yaw), 0.01);
  for (std::size_t i = 0; i < plain.size(); i += 100)
    EXPECT_THAT(moved[i].odom_T_robot, PoseNear(moved_T_odom * plain[i].odom_T_robot, 1e-9, 1e-9));
}

TEST(JitteredRecording, ScalesEachStepOfTheOdometryByChance) {
  JitterConfig config = kNone;
  config.odometry_noise = 0.01;
  const std::vector<OdometrySample> noisy = jittered(config).odometry;
  EXPECT_THAT(noisy[0].odom_T_robot, PoseNear(Pose2{3, 4, 1}, 1e-12, 1e-12));
  std::vector<double> ways, turns, products;
  for (std::size_t i = 1; i < noisy.size(); ++i) {
    const Pose2 step = noisy[i - 1].odom_T_robot.inverse() * noisy[i].odom_T_robot;
    EXPECT_NEAR(step.y / step.x, kStep.y / kStep.x, 1e-9);
    ways.push_back(step.x / kStep.x - 1.0);
    turns.push_back(step.yaw / kStep.yaw - 1.0);
    products.push_back(ways.back() * turns.back());
  }
  EXPECT_NEAR(deviation(ways), 0.01, 0.0005);
  EXPECT_NEAR(deviation(turns), 0.01, 0.0005);
  EXPECT_NEAR(mean(ways), 0.0, 0.0006);
  EXPECT_NEAR(mean(turns), 0.0, 0.0006);
  EXPECT_NEAR(mean(products) / 1e-4, 0.0, 0.06) << "way and turn are scaled independently";
}

TEST(JitteredRecording, TurnsTheImuByAConstantAngleAndKeepsItsTilt) {
  JitterConfig config = kNone;
  config.turn_imu = true;
  const std::vector<ImuSample> turned = jittered(config).imu, plain = jittered(kNone).imu;
  const double by = turn(yaw_of(plain[0].world_q_robot), yaw_of(turned[0].world_q_robot));
  EXPECT_GT(std::abs(by), 0.01);
  for (std::size_t i = 0; i < plain.size(); i += 100) {
    const auto up = [](const ImuSample& s) -> Eigen::Vector3d {
      return s.world_q_robot.inverse() * Eigen::Vector3d::UnitZ();
    };
    EXPECT_NEAR(wrap_angle(yaw_of(plain[i].world_q_robot) + by - yaw_of(turned[i].world_q_robot)), 0, 1e-9);
    EXPECT_LT((up(turned[i]) - up(plain[i])).norm(), 1e-9);
  }
}

TEST(JitteredRecording, StaysClean) {
  for (const Record& record : jittered({}).records) EXPECT_TRUE(test::is_clean(record));
}

TEST(JitteredRecording, PassesOnWhatTheRecordingSaysOfItself) {
  auto made = std::make_unique<MadeRecording>(drive(10), "made: broken");
  JitteredRecording recording(std::move(made), {}, 1);
  EXPECT_EQ(recording.damage(), "made: broken");
  EXPECT_EQ(recording.progress(), 0.0);
  test::read_all(recording);
  EXPECT_EQ(recording.progress(), 1.0);
}

// The engine is the standard's own; this holds what is made of it.
TEST(PortableRandom, GivesTheSameNumbersEverywhere) {
  PortableRandom random(1, 0);
  EXPECT_DOUBLE_EQ(random.uniform(), 0.75843763382516283);
  EXPECT_DOUBLE_EQ(random.gauss(), 0.7544659853796859);
}

TEST(PortableRandom, HasOtherNumbersInEachStream) {
  EXPECT_NE(PortableRandom(1, 0).uniform(), PortableRandom(1, 1).uniform());
  EXPECT_NE(PortableRandom(1, 0).uniform(), PortableRandom(1ULL << 32, 0).uniform());
}

TEST(PortableRandom, IsNormal) {
  PortableRandom random(3, 0);
  int within_one = 0, within_two = 0;
  for (int i = 0; i < 10000; ++i) {
    const double g = std::abs(random.gauss());
    within_one += g < 1.0 ? 1 : 0;
    within_two += g < 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(within_one, 6827, 150);
  EXPECT_NEAR(within_two, 9545, 70);
}

}  // namespace
}  // namespace dynslam::jitter
