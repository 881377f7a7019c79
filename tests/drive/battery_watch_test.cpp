// SPDX-License-Identifier: MIT
#include "drive/battery_watch.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

/// Reads 50 times a second.
struct Bench {
  BatteryWatch watch;
  Time now;
  int reports = 0;

  bool supply_low = false;

  void read(std::optional<double> volts, double seconds = 0.02) {
    for (int i = 0; i < seconds * 50 - 0.5; ++i) {
      now += std::chrono::milliseconds(20);
      reports += watch.update(now, volts, supply_low) ? 1 : 0;
    }
  }
};

TEST(BatteryWatch, KnowsNothingBeforeAReading) {
  Bench b;
  b.read(std::nullopt, 1);
  EXPECT_EQ(b.watch.shown().level, BatteryLevel::kUnknown);
  EXPECT_FALSE(b.watch.voltage_v());
  EXPECT_EQ(b.reports, 0);
}

TEST(BatteryWatch, NonsenseIsNoReading) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Bench b;
  b.read(12.5, 1);
  for (const double nonsense : {0.0, -12.0, 3.9, 99.0, kNan, kInf, -kInf}) b.read(nonsense, 0.5);
  EXPECT_NEAR(*b.watch.voltage_v(), 12.5, 1e-9);
  EXPECT_FALSE(b.watch.shown().brownout);
  EXPECT_EQ(b.watch.power_share(), 1.0);
}

TEST(BatteryWatch, ForgetsWhatWasLongAgo) {
  Bench b;
  b.read(12.5, 1);
  b.read(std::nullopt, 4.9);
  EXPECT_TRUE(b.watch.voltage_v());
  b.read(std::nullopt, 0.2);
  EXPECT_FALSE(b.watch.voltage_v());
  EXPECT_EQ(b.watch.shown().level, BatteryLevel::kUnknown);
}

TEST(BatteryWatch, LevelsHaveHysteresis) {
  struct Step {
    double volts;
    BatteryLevel level;
  };
  using enum BatteryLevel;
  Bench b;
  for (const Step& s : std::vector<Step>{{11.8, kGood},
                                         {11.65, kGood},
                                         {11.5, kLow},
                                         {11.8, kLow},
                                         {12.1, kGood},
                                         {10.9, kRecharge},
                                         {11.2, kRecharge},
                                         {11.4, kLow},
                                         {11.1, kLow},
                                         {10.9, kRecharge},
                                         {12.5, kGood}}) {
    b.read(s.volts, 200);
    EXPECT_EQ(b.watch.shown().level, s.level) << s.volts;
  }
}

TEST(BatteryWatch, DipsUnderLoadAreAveragedAndNotReported) {
  Bench b;
  b.read(11.9, 20);
  const int before = b.reports;
  for (int i = 0; i < 100; ++i) {
    b.read(11.2, 0.2);
    b.read(12.0, 1.8);
  }
  EXPECT_EQ(b.reports, before);
  EXPECT_EQ(b.watch.shown().level, BatteryLevel::kGood);
  EXPECT_NEAR(*b.watch.voltage_v(), 11.92, 0.05);
}

TEST(BatteryWatch, ABatteryThatRunsDownIsReportedAFewTimesOnly) {
  Bench b;
  for (int i = 0; i < 3000; ++i) b.read(13.0 - 0.001 * i, 1);
  EXPECT_EQ(b.watch.shown().level, BatteryLevel::kRecharge);
  EXPECT_GT(b.reports, 10);
  EXPECT_LT(b.reports, 30);
}

TEST(BatteryWatch, OneLowReadingIsABrownoutAtOnce) {
  Bench b;
  b.read(12.5, 20);
  const int before = b.reports;
  b.read(10.0);
  EXPECT_FALSE(b.watch.shown().brownout) << "not under the threshold";
  b.read(9.99);
  EXPECT_TRUE(b.watch.shown().brownout);
  EXPECT_EQ(b.reports, before + 1);
  EXPECT_NEAR(b.watch.power_share(), 0.7, 1e-9);
  EXPECT_EQ(b.watch.shown().level, BatteryLevel::kGood);
  b.read(12.5, 1.9);
  EXPECT_TRUE(b.watch.shown().brownout);
  EXPECT_NEAR(b.watch.power_share(), 0.7, 1e-9);
  b.read(12.5, 0.2);
  EXPECT_FALSE(b.watch.shown().brownout);
  b.read(12.5, 1.4);
  EXPECT_GT(b.watch.power_share(), 0.8);
  EXPECT_LT(b.watch.power_share(), 0.9) << "it comes back slowly";
  b.read(12.5, 3);
  EXPECT_EQ(b.watch.power_share(), 1.0);
}

TEST(BatteryWatch, ALastingBrownoutCutsAgainButNotToNothing) {
  Bench b;
  b.read(12.5, 1);
  b.read(9.5, 0.24);
  EXPECT_NEAR(b.watch.power_share(), 0.7, 1e-9) << "a cut takes time to show";
  b.read(9.5, 0.1);
  EXPECT_NEAR(b.watch.power_share(), 0.49, 1e-9);
  b.read(9.5, 10);
  EXPECT_NEAR(b.watch.power_share(), 0.2, 1e-9);
}

TEST(BatteryWatch, AComputersLowSupplyIsABrownoutWhateverTheVoltage) {
  for (const std::optional<double> volts : {std::optional(12.5), std::optional<double>()}) {
    Bench b;
    b.read(volts, 1);
    b.supply_low = true;
    b.read(volts);
    EXPECT_TRUE(b.watch.shown().brownout);
    EXPECT_NEAR(b.watch.power_share(), 0.7, 1e-9);
    b.read(volts, 0.9);
    EXPECT_NEAR(b.watch.power_share(), 0.7, 1e-9) << "the computer was not asked again yet";
    b.read(volts, 0.2);
    EXPECT_NEAR(b.watch.power_share(), 0.49, 1e-9);
    b.read(volts, 20);
    EXPECT_NEAR(b.watch.power_share(), 0.2, 1e-9);
    b.supply_low = false;
    b.read(volts, 1.9);
    EXPECT_TRUE(b.watch.shown().brownout);
    b.read(volts, 0.2);
    EXPECT_FALSE(b.watch.shown().brownout);
    b.read(volts, 9);
    EXPECT_EQ(b.watch.power_share(), 1.0);
  }
}

TEST(BatteryWatch, AClockThatRunsBackwardsGivesNoPowerBack) {
  Bench b;
  b.read(12.5, 1);
  b.read(9.0);
  b.now -= std::chrono::seconds(100);
  b.read(12.5, 0.04);
  EXPECT_LT(b.watch.power_share(), 0.72);
  EXPECT_NEAR(*b.watch.voltage_v(), 12.5, 1e-9);
}

TEST(BatteryConfig, VoltagesOutOfOrderAreAProblem) {
  EXPECT_FALSE(BatteryConfig().problem());
  BatteryConfig config;
  config.low_under_v = config.good_over_v;
  EXPECT_TRUE(config.problem());
}

}  // namespace
}  // namespace dynslam
