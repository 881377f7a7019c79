// SPDX-License-Identifier: MIT
#include "sim/robot_body.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "sim/small_world.h"

namespace dynslam {
namespace {

const RobotBody::Blocked kNowhere = [](const Pose2&) { return false; };

void run(RobotBody& body, const WheelPower& power, double seconds,
         const RobotBody::Blocked& blocked = kNowhere) {
  body.set_power(power);
  for (int i = 0; i < std::lround(seconds / 0.002); ++i) body.step(0.002, blocked);
}

TEST(RobotBody, ReachesItsTopSpeedAtFullPowerAndFullBattery) {
  RobotBody body(bare_room(), 1);
  run(body, {1, 1}, 1.5);
  EXPECT_NEAR(body.twist().v_mps, RobotBody::kTopSpeed_mps, 0.15);
  EXPECT_NEAR(body.twist().w_radps, 0.0, 0.5);
}

TEST(RobotBody, LagsBehindItsCommand) {
  RobotBody body(bare_room(), 1);
  run(body, {0.4, 0.4}, 3.0);
  const double steady = body.twist().v_mps;
  RobotBody again(bare_room(), 1);
  run(again, {0.4, 0.4}, RobotBody::kMotorLag_s);
  EXPECT_NEAR(again.twist().v_mps / steady, 0.632, 0.08);
}

TEST(RobotBody, TurnsLeftWhenTheRightWheelsPush) {
  RobotBody body(bare_room(), 1);
  run(body, {-0.3, 0.3}, 0.6);
  EXPECT_GT(body.twist().w_radps, 1.0);
  EXPECT_GT(body.pose().world_T_robot.yaw, 0.3);
  EXPECT_NEAR(body.pose().world_T_robot.x, 2.0, 0.03);
}

TEST(RobotBody, NeedsSomePowerToMoveAndMoreToTurn) {
  RobotBody body(bare_room(), 1);
  run(body, {0.05, 0.05}, 1.0);
  EXPECT_EQ(body.distance_m(), 0.0);
  run(body, {-0.12, 0.12}, 1.0);
  EXPECT_EQ(body.twist(), Twist{});
  run(body, {0.12, 0.12}, 1.0);
  EXPECT_GT(body.distance_m(), 0.1);
}

TEST(RobotBody, AccelerationOnALowBatteryBrownsOut) {
  RobotBody body(bare_room(), 1);
  run(body, {0, 0}, 0.1);
  const double idle = body.battery().voltage_v();
  body.battery().set_share(0.05);
  run(body, {1, 1}, 0.04);
  EXPECT_LT(body.battery().voltage_v(), 7.5);
  run(body, {1, 1}, 1.5);
  EXPECT_GT(body.battery().voltage_v(), 9.0) << "at speed it draws less";
  EXPECT_GT(idle, 13.0);
}

TEST(RobotBody, EmptiesItsBattery) {
  RobotBody body(bare_room(), 1);
  run(body, {0.5, 0.5}, 60.0);
  EXPECT_LT(body.battery().share(), 0.995);
  EXPECT_GT(body.battery().share(), 0.95);
}

TEST(RobotBody, StopsAtAWallAndCountsOneContact) {
  RobotBody body(bare_room(), 1);
  const RobotBody::Blocked beyond_3 = [](const Pose2& p) { return p.x > 3.0; };
  run(body, {0.5, 0.5}, 3.0, beyond_3);
  EXPECT_NEAR(body.pose().world_T_robot.x, 3.0, 0.01);
  EXPECT_EQ(body.contacts(), 1);
  run(body, {-0.3, -0.3}, 1.0, beyond_3);
  EXPECT_LT(body.pose().world_T_robot.x, 2.8);
  run(body, {0.5, 0.5}, 2.0, beyond_3);
  EXPECT_EQ(body.contacts(), 2);
}

TEST(RobotBody, TouchesWhatItRanIntoUntilEitherGoesAway) {
  RobotBody body(bare_room(), 1);
  double wall_x = 3.0;
  const RobotBody::Blocked beyond = [&](const Pose2& p) { return p.x > wall_x; };
  run(body, {0.5, 0.5}, 0.5, beyond);
  EXPECT_FALSE(body.touches());
  run(body, {0.5, 0.5}, 3.0, beyond);
  EXPECT_TRUE(body.touches());
  run(body, {0, 0}, 2.0, beyond);
  EXPECT_TRUE(body.touches()) << "it stands at the wall";
  run(body, {-0.3, -0.3}, 0.5, beyond);
  EXPECT_FALSE(body.touches());
  run(body, {0.5, 0.5}, 2.0, beyond);
  run(body, {0, 0}, 1.0, beyond);
  EXPECT_TRUE(body.touches());
  wall_x = 4.0;
  run(body, {0, 0}, 0.1, beyond);
  EXPECT_FALSE(body.touches()) << "what it touched went away";
}

TEST(RobotBody, NoseGoesUpThenDownOverADoorstep) {
  World world = bare_room();
  world.doorsteps.push_back({{3.0, 2.0}, {3.0, 4.0}, 0.04, 0.008});
  RobotBody body(world, 1);
  body.set_power({0.2, 0.2});
  double up = 0, down = 0, lift = 0;
  for (int i = 0; i < 2500; ++i) {
    body.step(0.002, kNowhere);
    up = std::max(up, body.pose().nose_up_rad);
    down = std::min(down, body.pose().nose_up_rad);
    lift = std::max(lift, body.pose().lift_m);
  }
  EXPECT_NEAR(up, 0.008 / RobotBody::kWheelBase_m, 0.02);
  EXPECT_NEAR(down, -0.008 / RobotBody::kWheelBase_m, 0.02);
  EXPECT_GT(lift, 0.003);
  EXPECT_NEAR(body.pose().nose_up_rad, 0.0, 1e-6) << "it is past the step";
}

TEST(RobotBody, SlipDependsOnTheSeed) {
  RobotBody one(bare_room(), 1), same(bare_room(), 1), other(bare_room(), 2);
  for (RobotBody* body : {&one, &same, &other}) run(*body, {0.4, 0.4}, 2.0);
  EXPECT_EQ(one.pose().world_T_robot, same.pose().world_T_robot);
  EXPECT_NE(one.pose().world_T_robot, other.pose().world_T_robot);
}

}  // namespace
}  // namespace dynslam
