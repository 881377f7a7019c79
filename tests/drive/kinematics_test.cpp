// SPDX-License-Identifier: MIT
#include "drive/kinematics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "drive/speed_ramp.h"

namespace dynslam {
namespace {

constexpr Twist kStand{0, 0};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Kinematics, StandingStillIsExactlyNoPower) {
  const Kinematics k;
  EXPECT_EQ(k.power(kStand, 12.0), WheelPower{});
  EXPECT_EQ(k.power({kNan, 1}, 12.0), WheelPower{});
  EXPECT_EQ(k.power({0, std::numeric_limits<double>::infinity()}, 12.0), WheelPower{});
  EXPECT_EQ(k.power({1e-6, 0}, 12.0), WheelPower{}) << "too slow for any wheel";
}

TEST(Kinematics, TurnsTheWheelsTheRightWay) {
  const Kinematics k;
  const WheelPower ahead = k.power({0.5, 0}, 12.0), back = k.power({-0.5, 0}, 12.0);
  EXPECT_GT(ahead.left, 0.2);
  EXPECT_EQ(ahead.left, ahead.right);
  EXPECT_EQ(back.left, -ahead.left);
  const WheelPower left = k.power({0, 1}, 12.0);
  EXPECT_LT(left.left, 0.0);
  EXPECT_EQ(left.right, -left.left);
}

TEST(Kinematics, MotorsNeverGetMoreThanTheirRatedVoltageNorTheComputersShare) {
  const Kinematics k;
  EXPECT_NEAR(k.most_power(14.0), 12.0 / 14.0, 1e-12);
  EXPECT_NEAR(k.most_power(12.0), 0.95, 1e-12);
  EXPECT_NEAR(k.most_power(10.0), 0.95, 1e-12);
  EXPECT_LT(k.most_power(std::nullopt), 0.87) << "unknown: as if freshly charged";
  for (const double volts : {9.0, 12.0, 14.5, 0.0, -1.0, kNan}) {
    const WheelPower p = k.power({99, 0}, volts);
    EXPECT_NEAR(p.left, k.most_power(volts), 1e-12) << volts;
    EXPECT_LE(p.left, 0.95) << volts;
  }
}

TEST(Kinematics, ALowerBatteryTakesALargerShareForTheSameSpeed) {
  const Kinematics k;
  const double high = k.power({1, 0}, 13.0).left, low = k.power({1, 0}, 11.0).left;
  EXPECT_NEAR(high * 13.0, low * 11.0, 1e-9);
}

/// What a wheel does with its power, where turning on the spot (1) or straight on (0) takes more or less.
double wheel_speed(double power, double battery_v, double turning) {
  const KinematicsConfig c;
  const double voltage = std::abs(power) * battery_v / c.motor_rated_v;
  const double pushing = std::max(0.0, voltage - c.deadband - c.turn_deadband * turning);
  return std::copysign(pushing / (1.0 - c.deadband) * c.max_speed_mps, power);
}

/// The twist that a power drives, when it is meant to drive `wanted`.
Twist driven(const WheelPower& power, double battery_v, const Twist& wanted) {
  const KinematicsConfig c;
  const double half = 0.5 * c.track_width_m * c.turn_slip, turn = std::abs(wanted.w_radps) * half;
  const double turning = turn / std::max(turn, std::abs(wanted.v_mps));
  const double left = wheel_speed(power.left, battery_v, turning),
               right = wheel_speed(power.right, battery_v, turning);
  return {0.5 * (left + right), 0.5 * (right - left) / half};
}

TEST(Kinematics, DrivesWhatWasAskedFor) {
  const Kinematics k;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> v(-1.2, 1.2), w(-3, 3), volts(10.5, 14);
  for (int i = 0; i < 1000; ++i) {
    const Twist wanted{v(random), w(random)};
    const double battery = volts(random);
    const Twist t = driven(k.power(wanted, battery), battery, wanted);
    // A wheel that is asked for next to nothing stands.
    EXPECT_NEAR(t.v_mps, wanted.v_mps, 0.003);
    EXPECT_NEAR(t.w_radps, wanted.w_radps, 0.02);
  }
}

TEST(Kinematics, TurningOnTheSpotTakesMoreThanDrivingStraight) {
  const Kinematics k;
  const double half_track_m = 0.5 * 0.2 * 1.5;
  EXPECT_NEAR(k.power({0, 0.3 / half_track_m}, 12.0).right - k.power({0.3, 0}, 12.0).right, 0.08, 1e-9)
      << "for the same speed of the wheels";
}

TEST(Kinematics, KeepsTheArcWhenAWheelSaturates) {
  const Kinematics k;
  for (const Twist& wanted : {Twist{2.2, 2.0}, Twist{-2.2, 2.9}, Twist{9, -9}, Twist{1, 10}}) {
    const Twist t = k.reachable(wanted, 12.0);
    EXPECT_LT(std::abs(t.v_mps), std::abs(wanted.v_mps));
    EXPECT_NEAR(t.v_mps * wanted.w_radps, t.w_radps * wanted.v_mps, 1e-9);
    const Twist done = driven(k.power(wanted, 12.0), 12.0, t);
    EXPECT_NEAR(done.v_mps, t.v_mps, 1e-9);
    EXPECT_NEAR(done.w_radps, t.w_radps, 1e-9);
  }
  EXPECT_EQ(k.reachable({1, 0.5}, 12.0), (Twist{1, 0.5}));
}

TEST(SpeedRamp, SpeedsUpAndSlowsDownAtItsOwnRates) {
  SpeedRamp ramp;
  const Duration tick = std::chrono::milliseconds(20);
  ramp.set(ramp.toward({1, 0}, tick));
  EXPECT_NEAR(ramp.now().v_mps, 0.02, 1e-12);
  for (int i = 0; i < 60; ++i) ramp.set(ramp.toward({1, 0}, tick));
  EXPECT_EQ(ramp.now(), (Twist{1, 0}));
  ramp.set(ramp.toward(kStand, tick));
  EXPECT_NEAR(ramp.now().v_mps, 0.96, 1e-12);
  for (int i = 0; i < 30; ++i) ramp.set(ramp.toward(kStand, tick));
  EXPECT_EQ(ramp.now(), kStand);
}

TEST(SpeedRamp, KeepsTheArcFromRest) {
  SpeedRamp ramp;
  for (int i = 0; i < 20; ++i) {
    ramp.set(ramp.toward({1, -2}, std::chrono::milliseconds(20)));
    EXPECT_NEAR(ramp.now().w_radps, -2 * ramp.now().v_mps, 1e-12);
  }
}

TEST(SpeedRamp, TurnsAroundThroughStandingStill) {
  SpeedRamp ramp;
  ramp.set({0.03, 0.1});
  ramp.set(ramp.toward({-1, -1}, std::chrono::milliseconds(20)));
  EXPECT_EQ(ramp.now(), kStand);
  ramp.set(ramp.toward({-1, -1}, std::chrono::milliseconds(20)));
  EXPECT_LT(ramp.now().v_mps, 0.0);
}

TEST(SpeedRamp, BrakingDoesNotWaitForATurn) {
  SpeedRamp ramp;
  ramp.set({1, 0});
  const Twist t = ramp.toward({0, 3}, std::chrono::milliseconds(100));
  EXPECT_NEAR(t.v_mps, 0.8, 1e-12);
  EXPECT_NEAR(t.w_radps, 0.6, 1e-12);
}

TEST(SpeedRamp, NoTimeChangesNothingAndLongTimeIsShort) {
  SpeedRamp ramp;
  ramp.set({0.5, 0});
  EXPECT_EQ(ramp.toward({1, 1}, Duration(0)), (Twist{0.5, 0}));
  EXPECT_EQ(ramp.toward({1, 1}, std::chrono::seconds(-5)), (Twist{0.5, 0}));
  EXPECT_NEAR(ramp.toward({2, 0}, std::chrono::hours(1)).v_mps, 0.6, 1e-12);
}

TEST(SpeedRamp, NeverOvershoots) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> v(-2, 2), w(-4, 4);
  SpeedRamp ramp;
  for (int i = 0; i < 2000; ++i) {
    const Twist before = ramp.now(), target{v(random), w(random)};
    const Twist after = ramp.toward(target, std::chrono::milliseconds(20));
    EXPECT_GE(after.v_mps, std::min(before.v_mps, target.v_mps) - 1e-12);
    EXPECT_LE(after.v_mps, std::max(before.v_mps, target.v_mps) + 1e-12);
    EXPECT_LE(std::abs(after.v_mps - before.v_mps), 0.04 + 1e-12);
    EXPECT_LE(std::abs(after.w_radps - before.w_radps), 0.24 + 1e-12);
    ramp.set(after);
  }
}

}  // namespace
}  // namespace dynslam
