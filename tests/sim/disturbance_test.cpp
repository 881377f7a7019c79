// SPDX-License-Identifier: MIT
#include "sim/disturbance.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "base/error.h"
#include "sim/small_world.h"
#include "support_matchers.h"

namespace dynslam {
namespace {

using ::testing::HasSubstr;

template <class Do>
std::string problem_with(Do&& act) {
  try {
    act();
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(Disturbance, ReadsFaults) {
  const ScheduledFault fault = parse_fault("lidar:unplugged:10:15.5");
  EXPECT_EQ(fault.device, SimDevice::kLidar);
  EXPECT_EQ(fault.kind, FaultKind::kUnplugged);
  EXPECT_EQ(fault.at_s, 10.0);
  EXPECT_EQ(fault.until_s, 15.5);
  EXPECT_GT(parse_fault("imu:frozen:3").until_s, 1e9);
}

TEST(Disturbance, ReadsKicks) {
  const ScheduledKick kick = parse_kick("30:1:-0.5:90");
  EXPECT_EQ(kick.at_s, 30.0);
  EXPECT_EQ(kick.robot_T_new, (Pose2{1.0, -0.5, radians(90.0)}));
  EXPECT_EQ(parse_kick("30:1:0").robot_T_new.yaw, 0.0);
}

TEST(Disturbance, SaysWhatIsWrong) {
  const auto fault = [](const char* text) { return problem_with([&] { parse_fault(text); }); };
  const auto kick = [](const char* text) { return problem_with([&] { parse_kick(text); }); };
  EXPECT_THAT(fault("lidar"), HasSubstr("DEVICE:KIND:FROM"));
  EXPECT_THAT(fault("lidar:frozen:1:2:3"), HasSubstr("DEVICE:KIND:FROM"));
  EXPECT_THAT(fault("radar:frozen:1"), HasSubstr("devices are lidar"));
  EXPECT_THAT(fault("lidar:broken:1"), HasSubstr("kinds are"));
  EXPECT_THAT(fault("pins:nan:1"), HasSubstr("cannot fail in this way"));
  EXPECT_THAT(fault("lidar:frozen:-1"), HasSubstr("'-1' is no number from 0"));
  EXPECT_THAT(fault("lidar:frozen:nan"), HasSubstr("'nan' is no number"));
  EXPECT_THAT(fault("lidar:frozen:3s"), HasSubstr("'3s' is no number"));
  EXPECT_THAT(fault("lidar:frozen:3:2"), HasSubstr("end after it begins"));
  EXPECT_THAT(kick("30"), HasSubstr("AT:FORWARD:LEFT"));
  EXPECT_THAT(kick("30:1:inf"), HasSubstr("'inf' is no number"));
  EXPECT_THAT(kick("30:1::2"), HasSubstr("'' is no number"));
}

TEST(Disturbance, TheWorldsScheduleCarriesTheRobotOff) {
  World world = bare_room();
  world.kicks = {{1.0, {1.0, 0.5, 0.3}}, {2.0, {100.0, 0.0, 0.0}}};
  SteppedSim sim(world);
  sim.go_to(0.99);
  EXPECT_EQ(sim.simulator->truth().kicks, 0);
  sim.go_to(1.01);
  EXPECT_EQ(sim.simulator->truth().world_T_robot, (world.world_T_start * Pose2{1.0, 0.5, 0.3}));
  sim.go_to(3.0);
  EXPECT_EQ(sim.simulator->truth().kicks, 1) << "there is nothing 100 m away";
  EXPECT_EQ(sim.simulator->truth().distance_m, 0.0) << "it did not drive there";
}

TEST(ReachableFloor, IsWhereTheRobotFits) {
  World world = bare_room();
  world.furniture.push_back(box_at(6, 3, 1.0, 0.0, 1.0));
  world.furniture.push_back(box_at(6, 5, 1.0, 0.5, 1.0));  // that it drives under
  world.walls.push_back({{{8, 0}, {10, 0}, {10, 6}, {8, 6}}});
  SteppedSim sim(world);
  const std::vector<Vector2> floor = sim.simulator->reachable_floor(0.1);
  const auto has = [&](double x, double y) {
    return std::any_of(floor.begin(), floor.end(),
                       [&](const Vector2& p) { return (p - Vector2(x, y)).norm() < 0.01; });
  };
  EXPECT_TRUE(has(2.0, 3.0));
  EXPECT_TRUE(has(0.2, 0.2));
  EXPECT_TRUE(has(6.0, 5.0));
  EXPECT_FALSE(has(6.0, 3.0)) << "within the box";
  EXPECT_FALSE(has(6.0, 3.6)) << "beside it";
  EXPECT_FALSE(has(9.0, 3.0)) << "behind a wall without a door";
  const double middle_m2 = (8 - 0.1 - 0.22) * (6 - 0.1 - 0.22) - 1.22 * 1.22;
  EXPECT_NEAR(0.01 * static_cast<double>(floor.size()), middle_m2, 0.06 * middle_m2);
}

}  // namespace
}  // namespace dynslam
