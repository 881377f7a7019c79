// SPDX-License-Identifier: MIT
#include "base/time.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angles.h"
#include "base/counters.h"
#include "base/imu_sample.h"

namespace dynslam {
namespace {

TEST(Time, KeepsNanosecondsOfTodaysStamps) {
  const Time t = Time(std::chrono::nanoseconds(1700001000123456789));
  EXPECT_EQ((t + from_seconds(1e-9)) - t, std::chrono::nanoseconds(1));
  EXPECT_NEAR(seconds_of(t), 1700001000.123456789, 1e-6);
}

TEST(Time, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(1.4e-9).count(), 1);
  EXPECT_EQ(from_seconds(-1.6e-9).count(), -2);
}

TEST(Time, RefusesWhatDoesNotFit) {
  EXPECT_TRUE(is_representable_s(1.7e9));
  EXPECT_FALSE(is_representable_s(1e10));
  EXPECT_FALSE(is_representable_s(NAN));
  EXPECT_FALSE(is_representable_s(-INFINITY));
}

TEST(ImuSample, YawIsTheTurnAboutTheVertical) {
  const Eigen::Quaterniond q = Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitX());
  EXPECT_NEAR(yaw_of(q), 2.5, 1e-12);
}

TEST(Counters, CountByName) {
  Counters c;
  EXPECT_TRUE(c.empty());
  c.add("a");
  c.add("a", 4);
  c.add("b");
  EXPECT_EQ(c["a"], 5U);
  EXPECT_EQ(c["b"], 1U);
  EXPECT_EQ(c["never"], 0U);
}

}  // namespace
}  // namespace dynslam
