// SPDX-License-Identifier: MIT
#include "drive/speed_control.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A floor that makes of each command something else.
struct Floor {
  explicit Floor(double v = 1.0, double w = 1.0, double deadband = 0.0)
      : speed_gain(v), turn_gain(w), turn_deadband_radps(deadband) {}

  double speed_gain, turn_gain, turn_deadband_radps;
  double held_back = 1.0;  ///< by Safety

  Twist twist;
  Twist told;
  Time now;
  SpeedControl control;

  /// Wants this for so long; 20 times a second.
  void drive(const Twist& wanted, double seconds) {
    for (double t = 0; t < seconds; t += 0.05) {
      const Twist command = control.correct(now, wanted, told, twist);
      told = {held_back * command.v_mps, held_back * command.w_radps};
      const bool turns = std::abs(told.w_radps) >= turn_deadband_radps;
      twist.v_mps += 0.3 * (speed_gain * told.v_mps - twist.v_mps);
      twist.w_radps += 0.3 * ((turns ? turn_gain * told.w_radps : 0.0) - twist.w_radps);
      now += std::chrono::milliseconds(50);
    }
  }
};

TEST(SpeedControl, LeavesATrueRobotAlone) {
  Floor floor;
  floor.drive({0.5, 0.6}, 20.0);
  EXPECT_NEAR(floor.control.gain().v_mps, 1.0, 0.01);
  EXPECT_NEAR(floor.control.gain().w_radps, 1.0, 0.01);
}

TEST(SpeedControl, LearnsToDriveWhatIsAsked) {
  for (const double gain : {0.6, 0.8, 1.3}) {
    Floor floor{gain, 1.0 / gain};
    floor.drive({0.5, 0.6}, 20.0);
    EXPECT_NEAR(floor.twist.v_mps, 0.5, 0.02) << gain;
    EXPECT_NEAR(floor.twist.w_radps, 0.6, 0.02) << gain;
    floor.drive({-0.3, -1.0}, 1.0);
    EXPECT_NEAR(floor.twist.v_mps, -0.3, 0.02) << "backwards too";
  }
}

TEST(SpeedControl, GainsAreBounded) {
  Floor slow{0.3, 0.3}, fast{4.0, 4.0};
  slow.drive({0.5, 0.9}, 60.0);
  fast.drive({0.5, 0.9}, 60.0);
  EXPECT_EQ(slow.control.gain().v_mps, 2.0);
  EXPECT_EQ(fast.control.gain().w_radps, 0.5);
}

TEST(SpeedControl, DoesNotLearnWhileItIsHeldBack) {
  Floor floor{0.7, 0.7};
  floor.held_back = 0.5;
  floor.drive({0.5, 0.9}, 20.0);
  EXPECT_EQ(floor.control.gain(), (Twist{1.0, 1.0}));
}

TEST(SpeedControl, DoesNotLearnFromWheelsThatSpin) {
  Floor floor{0.8, 0.8};
  floor.drive({0.5, 0.9}, 20.0);
  EXPECT_NEAR(floor.control.gain().v_mps, 1.25, 0.03);
  floor.speed_gain = floor.turn_gain = 0.0;
  floor.drive({0.5, 0.9}, 30.0);
  EXPECT_NEAR(floor.control.gain().v_mps, 1.0, 0.03) << "forgets instead";
  EXPECT_NEAR(floor.control.gain().w_radps, 1.0, 0.03);
}

TEST(SpeedControl, PushesUntilASlowTurnBegins) {
  for (const double deadband : {0.25, 0.4, 0.6}) {
    Floor floor{1.0, 1.0, deadband};
    double turned = 0.0;
    for (int i = 0; i < 40; ++i) {
      floor.drive({0.0, -0.15}, 0.05);
      turned += 0.05 * floor.twist.w_radps;
    }
    EXPECT_LT(turned, -0.08) << deadband;
    floor.drive({}, 0.05);
    EXPECT_FALSE(is_moving(floor.told)) << "and no longer than it is asked to";
  }
}

TEST(SpeedControl, ThePushIsBoundedAndLeavesAtOnceForTheOtherSide) {
  Floor stuck{1.0, 1.0, 100.0};
  stuck.drive({0.0, 0.15}, 30.0);
  EXPECT_LE(stuck.told.w_radps, 0.76);
  stuck.drive({0.0, -0.15}, 0.05);
  EXPECT_LT(stuck.told.w_radps, 0.0);
}

TEST(SpeedControl, DoesNotPushWhatIsHeld) {
  Floor held{1.0, 1.0, 0.3};
  held.held_back = 0.0;
  held.drive({0.0, 0.2}, 5.0);
  held.held_back = 1.0;
  held.drive({0.0, 0.2}, 0.05);
  EXPECT_NEAR(held.told.w_radps, 0.2, 1e-9);
}

TEST(SpeedControl, NonsenseIsNotLearnedAndNeverCommanded) {
  SpeedControl control;
  Time now;
  for (const double bad : {kNan, std::numeric_limits<double>::infinity()}) {
    for (int i = 0; i < 100; ++i) {
      now += std::chrono::milliseconds(50);
      EXPECT_EQ(control.correct(now, {0.5, 0.1}, {0.5, 0.1}, {bad, bad}), (Twist{0.5, 0.1}));
      EXPECT_EQ(control.correct(now, {bad, 0.0}, {}, {}), Twist{});
      EXPECT_TRUE(is_finite(control.correct(now, {0.5, 0.1}, {bad, bad}, {})));
    }
  }
  EXPECT_EQ(control.gain(), (Twist{1.0, 1.0}));
  now -= std::chrono::seconds(100);
  EXPECT_TRUE(is_finite(control.correct(now, {0.5, 0.1}, {0.5, 0.1}, {0.5, 0.1})));
}

}  // namespace
}  // namespace dynslam
