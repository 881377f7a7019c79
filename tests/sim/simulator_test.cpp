// SPDX-License-Identifier: MIT
#include "sim/simulator.h"

#include <algorithm>
#include <thread>

#include <gtest/gtest.h>

#include "base/error.h"
#include "device/device_error.h"
#include "sim/robot_shape.h"
#include "sim/small_world.h"
#include "support_matchers.h"

namespace dynslam {
namespace {

using namespace std::chrono_literals;

std::optional<Scan> newest_scan(SteppedSim& sim) {
  std::optional<Scan> newest;
  while (auto scan = sim.devices.lidar->next(sim.clock.now())) newest = std::move(scan);
  return newest;
}

std::vector<ImuSample> all_samples(SteppedSim& sim) {
  std::vector<ImuSample> all;
  while (auto sample = sim.devices.imu->next(sim.clock.now())) all.push_back(*sample);
  return all;
}

TEST(Simulator, DrivesStraightForATime) {
  SteppedSim sim(bare_room());
  sim.drive({0.3, 0.3}, 0.0, 2.0);
  const SimTruth truth = sim.simulator->truth();
  const double speed = truth.twist.v_mps;
  EXPECT_NEAR(truth.distance_m, speed * (2.0 - RobotBody::kMotorLag_s), 0.06);
  EXPECT_NEAR(truth.world_T_robot.x, 2.0 + truth.distance_m, 0.02);
}

TEST(Simulator, TheBoardStopsTheMotorsWhenItHearsNothing) {
  SteppedSim sim(bare_room());
  sim.drive({0.4, 0.4}, 0.0, 1.0);  // the last command at 0.98 s
  sim.go_to(0.98 + 0.248);
  const double before = sim.simulator->truth().twist.v_mps;
  EXPECT_GT(before, 0.6);
  sim.go_to(0.98 + 0.25 + 0.12);
  EXPECT_LT(sim.simulator->truth().twist.v_mps, 0.45 * before);
  sim.go_to(3.0);
  EXPECT_LT(sim.simulator->truth().twist.v_mps, 1e-3);
}

TEST(Simulator, NothingMovesBeforeTheFirstCommand) {
  SteppedSim sim(bare_room());
  sim.go_to(2.0);
  EXPECT_EQ(sim.simulator->truth().world_T_robot, bare_room().world_T_start);
  EXPECT_EQ(sim.simulator->truth().contacts, 0);
}

TEST(Simulator, NeverDrivesThroughAWall) {
  SteppedSim sim(bare_room());
  sim.drive({1, 1}, 0.0, 6.0);
  EXPECT_LT(sim.simulator->truth().world_T_robot.x, 8.0 - 0.05 - 0.12);
  EXPECT_GE(sim.simulator->truth().contacts, 1);
  EXPECT_LE(sim.simulator->truth().contacts, 2);
}

TEST(Simulator, ALowThingStopsTheRobotAndATableDoesNot) {
  for (const bool is_table : {false, true}) {
    World world = bare_room();
    world.furniture.push_back(is_table ? box_at(4, 3, 0.5, 0.4, 0.5) : box_at(4, 3, 0.5, 0.0, 0.1));
    SteppedSim sim(world);
    sim.drive({0.4, 0.4}, 0.0, 3.0);
    EXPECT_EQ(sim.simulator->truth().world_T_robot.x > 4.0, is_table);
  }
}

TEST(SimLidar, ATurnTakesATenthOfASecond) {
  SteppedSim sim(bare_room());
  sim.go_to(0.105);
  EXPECT_FALSE(sim.devices.lidar->next(sim.clock.now()).has_value()) << "still in the wire";
  sim.go_to(0.106);
  const auto scan = sim.devices.lidar->next(sim.clock.now());
  ASSERT_TRUE(scan.has_value());
  EXPECT_EQ(scan->stamp, sim.begin);
  ASSERT_EQ(scan->beams.size(), 1200U);
  EXPECT_NEAR(scan->beams.front().angle_rad, -kPi, 1e-6);
  EXPECT_NEAR(scan->beams.back().time_s, 0.1 * 1199 / 1200, 1e-6);
  EXPECT_TRUE(std::is_sorted(scan->beams.begin(), scan->beams.end(),
                             [](const Beam& a, const Beam& b) { return a.angle_rad < b.angle_rad; }));
  EXPECT_FALSE(sim.devices.lidar->next(sim.clock.now()).has_value());
}

TEST(SimLidar, SeesTheRoomWithNoise) {
  SteppedSim sim(bare_room());
  sim.go_to(0.2);
  const Scan scan = *newest_scan(sim);
  EXPECT_NEAR(median_range(scan, 0.0), 5.95, 0.03);
  EXPECT_NEAR(median_range(scan, kPi / 2), 2.95, 0.03);
  EXPECT_NEAR(median_range(scan, -kPi / 2), 2.95, 0.03);
  EXPECT_NEAR(median_range(scan, kPi), 1.95, 0.03);
  double sum2 = 0;
  int n = 0;
  for (const Beam& b : scan.beams) {
    const double off = b.range_m * std::cos(b.angle_rad) - 5.95;
    if (std::abs(b.angle_rad) < 0.3 && std::abs(off) < 0.3) sum2 += off * off, ++n;
  }
  EXPECT_NEAR(std::sqrt(sum2 / n), 0.04, 0.015) << "1 cm and 0.5 % of 6 m";
}

TEST(SimLidar, EachBeamComesFromWhereTheRobotIsAtItsTime) {
  SteppedSim sim(bare_room());
  sim.drive({0.7, 0.7}, 0.0, 1.2);  // at about 1.5 m/s, 15 cm a turn
  const Scan scan = *newest_scan(sim);
  const auto range_by = [&](double bearing, double at_turn_share) {
    const Time t = scan.stamp + from_seconds(0.1 * at_turn_share);
    return 5.95 + 2.0 - sim.simulator->true_pose(t)->x - median_range(scan, bearing);
  };
  EXPECT_NEAR(range_by(0.0, 0.5), 0.0, 0.03);
  const double behind_early = median_range(scan, -kPi + 0.03, 0.03),
               behind_late = median_range(scan, kPi - 0.03, 0.03);
  EXPECT_NEAR(behind_late - behind_early, 0.1 * sim.simulator->truth().twist.v_mps, 0.04);
}

TEST(SimLidar, SeesADoorClose) {
  World world = bare_room();
  Door door;
  door.hinge = {5, 2.5};
  door.latch = {5, 3.5};
  door.opens_rad = -kPi / 2;
  door.schedule = {{1.0, 0.0}};
  world.doors.push_back(door);
  SteppedSim sim(world);
  sim.go_to(0.9);
  EXPECT_NEAR(median_range(*newest_scan(sim), 0.0), 5.95, 0.05);
  sim.go_to(3.0);
  EXPECT_NEAR(median_range(*newest_scan(sim), 0.0), 2.98, 0.05);
}

TEST(SimLidar, OnADoorstepFarBeamsMeetTheFloor) {
  World world = bare_room();
  world.doorsteps.push_back(
      {{2.0 - RobotBody::kWheelBase_m / 2, 2}, {2.0 - RobotBody::kWheelBase_m / 2, 4}, 0.04, 0.01});
  SteppedSim sim(world);  // it stands with its rear wheels on the step
  sim.go_to(0.5);
  const Scan scan = *newest_scan(sim);
  const double floor_m = (0.18 + 0.005) * RobotBody::kWheelBase_m / 0.01;
  EXPECT_NEAR(median_range(scan, 0.0), floor_m, 0.25);
  EXPECT_NEAR(median_range(scan, kPi / 2), 2.95, 0.05) << "to the sides it is level";
}

TEST(SimLidar, DarkThingsSwallowBeams) {
  World world = bare_room();
  Furniture bag = box_at(4, 3, 0.5, 0, 1);
  bag.parts.front().dark = 0.6;
  world.furniture.push_back(bag);
  SteppedSim sim(world);
  sim.go_to(0.2);
  int lost = 0, all = 0;
  const Scan scan = *newest_scan(sim);
  for (const Beam& b : scan.beams) {
    if (std::abs(b.angle_rad) > 0.12) continue;
    ++all;
    lost += is_return(b) ? 0 : 1;
  }
  EXPECT_NEAR(static_cast<double>(lost) / all, 0.6, 0.25);
}

TEST(SimImu, FollowsTheHeadingBehindAnUnknownOffset) {
  SteppedSim sim(bare_room());
  sim.drive({-0.3, 0.3}, 0.0, 2.0);
  const auto samples = all_samples(sim);
  ASSERT_GT(samples.size(), 60U) << "older ones are lost: 64 are kept";
  EXPECT_EQ(samples[1].stamp - samples[0].stamp, 10ms);
  const auto off = [&](const ImuSample& s) {
    return turn(sim.simulator->true_pose(s.stamp - ImuModel::kLag)->yaw, yaw_of(s.world_q_robot));
  };
  int spikes = 0;
  for (const ImuSample& s : samples)
    spikes += std::abs(turn(off(samples.front()), off(s))) > radians(5.0) ? 1 : 0;
  EXPECT_LE(spikes, 2);
  EXPECT_GT(std::abs(off(samples.front())), 0.01) << "the offset is arbitrary";
}

TEST(SimImu, TellsOfTilt) {
  World world = bare_room();
  world.doorsteps.push_back(
      {{2.0 - RobotBody::kWheelBase_m / 2, 2}, {2.0 - RobotBody::kWheelBase_m / 2, 4}, 0.04, 0.01});
  SteppedSim sim(world);
  sim.go_to(0.6);
  const Eigen::Vector3d ahead = all_samples(sim).back().world_q_robot * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::asin(ahead.z()), -0.01 / RobotBody::kWheelBase_m, radians(1.5)) << "its nose is down";
}

TEST(SimMotors, MeasureTheBatteryInSteps) {
  SteppedSim sim(bare_room());
  sim.go_to(1.0);
  const MotorState state = sim.devices.motors->read();
  EXPECT_NEAR(state.battery_v, 13.6, 0.3);
  const double steps = state.battery_v / (36.3 / 1023);
  EXPECT_NEAR(steps, std::round(steps), 1e-9);
  EXPECT_TRUE(state.failsafe_on);
  sim.simulator->set_battery(0.1);
  EXPECT_LT(sim.devices.motors->read().battery_v, 11.6);
}

TEST(SimPins, ShowTheEmergencyStop) {
  SteppedSim sim(bare_room());
  EXPECT_FALSE(sim.devices.pins->read().estop_pressed);
  sim.simulator->press_estop(true);
  EXPECT_TRUE(sim.devices.pins->read().estop_pressed);
  sim.simulator->press_estop(false);
  EXPECT_FALSE(sim.devices.pins->read().estop_pressed);
}

TEST(SimPins, TellOfABump) {
  SteppedSim sim(bare_room());
  EXPECT_EQ(sim.devices.pins->read().bumper_pressed, false);
  sim.drive({0.5, 0.5}, 0.0, 9.0);
  EXPECT_EQ(sim.devices.pins->read().bumper_pressed, true);
  sim.drive({-0.3, -0.3}, 9.0, 10.0);
  EXPECT_EQ(sim.devices.pins->read().bumper_pressed, false);
}

/// All that one run tells, with questions asked every so often. Commands fall on multiples of 50 ms.
std::vector<double> told(Duration step, std::uint64_t seed) {
  World world = bare_room();
  world.people.emplace_back().route = {{5, 1}, {5, 5}};
  world.doorsteps.push_back({{3.0, 2.0}, {3.0, 4.0}});
  SteppedSim sim(world, seed);
  std::vector<double> numbers;
  for (Time t = sim.begin; t <= sim.begin + 2s; t += step) {
    sim.clock.set(t);
    if ((t - sim.begin) % 50ms == Duration::zero()) sim.devices.motors->drive({0.35, 0.3});
    while (auto scan = sim.devices.lidar->next(t)) {
      for (const Beam& b : scan->beams) numbers.push_back(is_return(b) ? b.range_m : -1.0);
    }
    while (auto sample = sim.devices.imu->next(t)) numbers.push_back(yaw_of(sample->world_q_robot));
  }
  const SimTruth truth = sim.simulator->truth();
  for (const double x : {truth.world_T_robot.x, truth.world_T_robot.yaw, truth.battery_v, truth.distance_m}) {
    numbers.push_back(x);
  }
  return numbers;
}

TEST(Simulator, DoesNotDependOnHowOftenItIsAsked) {
  auto often = told(1ms, 5), seldom = told(50ms, 5);
  std::sort(often.begin(), often.end());  // the samples of several devices come interleaved otherwise
  std::sort(seldom.begin(), seldom.end());
  EXPECT_EQ(often, seldom);
}

TEST(Simulator, TheSeedDecides) {
  EXPECT_EQ(told(10ms, 5), told(10ms, 5));
  EXPECT_NE(told(10ms, 5), told(10ms, 6));
}

TEST(Simulator, OneDeviceDoesNotDisturbAnother) {
  SteppedSim alone(bare_room()), together(bare_room());
  for (SteppedSim* sim : {&alone, &together}) {
    for (int i = 0; i < 30; ++i) {
      sim->go_to(0.02 * i);
      sim->devices.motors->drive({0.3, 0.3});
      if (sim == &together) sim->devices.motors->read();
      if (sim == &together) sim->devices.imu->next(sim->clock.now());
    }
  }
  const Scan a = *newest_scan(alone), b = *newest_scan(together);
  for (std::size_t i = 0; i < a.beams.size(); ++i) ASSERT_EQ(a.beams[i].range_m, b.beams[i].range_m);
}

TEST(Simulator, KicksTheRobotIntoFreeSpaceOnly) {
  World world = bare_room();
  world.furniture.push_back(box_at(4, 3, 1.0, 0, 1));
  Furniture moved = box_at(6, 3, 1.0, 0, 1);
  moved.moves = {{0.1, 0.5, {6, 1, 0}}};
  world.furniture.push_back(moved);
  SteppedSim sim(world);
  sim.go_to(1.0);
  EXPECT_FALSE(sim.simulator->kick({2.0, 0.0, 0.0})) << "there stands a box";
  EXPECT_FALSE(sim.simulator->kick({4.0, -2.0, 0.0})) << "there stands one now";
  EXPECT_FALSE(sim.simulator->kick({-1.9, 0.0, 0.0})) << "that is in the wall";
  EXPECT_FALSE(sim.simulator->kick({20.0, 0.0, 0.0})) << "out of the world";
  EXPECT_THAT(sim.simulator->truth().world_T_robot, PoseNear(Pose2{2, 3, 0}, 1e-12, 1e-12));
  EXPECT_TRUE(sim.simulator->kick({0.0, 1.0, 0.5}));
  EXPECT_THAT(sim.simulator->truth().world_T_robot, PoseNear(Pose2{2, 4, 0.5}, 1e-12, 1e-12));
}

TEST(Simulator, KeepsTheTruth) {
  SteppedSim sim(bare_room());
  sim.drive({0.3, 0.3}, 0.0, 1.0);
  const auto truth = sim.simulator->truth_since(sim.begin);
  ASSERT_EQ(truth.size(), 100U);
  EXPECT_EQ(truth.front().stamp, sim.begin + 10ms);
  EXPECT_EQ(truth.back().stamp, sim.begin + 1s);
  EXPECT_TRUE(sim.simulator->truth_since(sim.begin + 1s).empty());
  const Pose2 between = *sim.simulator->true_pose(sim.begin + 505ms);
  EXPECT_GT(between.x, truth[49].world_T_robot.x);
  EXPECT_LT(between.x, truth[50].world_T_robot.x);
  EXPECT_FALSE(sim.simulator->true_pose(sim.begin + 2s).has_value());
  EXPECT_FALSE(sim.simulator->true_pose(sim.begin - 1s).has_value());
}

TEST(Simulator, TheRoomAroundTheRobotIsThatOfItsBody) {
  World world = bare_room();
  world.furniture.push_back(box_at(2.0, 3.4, 0.2, 0.0, 0.5));
  world.furniture.push_back(box_at(2.0, 2.8, 0.1, 1.0, 1.5));  // over its head
  Person anna;
  anna.route = {{2.0, 2.5}, {2.0, 1.0}};
  anna.starts_at_s = 1e6;
  world.people.push_back(anna);
  SteppedSim sim(world);
  EXPECT_NEAR(sim.simulator->room().to_things_m, 0.4 - 0.1 - kRobotWidth_m / 2, 1e-9);
  constexpr double kLeg_m = 0.07;
  EXPECT_NEAR(sim.simulator->room().to_people_m, 0.5 - kLeg_m - kRobotWidth_m / 2, 1e-9);
}

TEST(Simulator, OutInTheOpenThereIsRoomEnough) {
  SteppedSim sim(bare_room());
  EXPECT_EQ(sim.simulator->room().to_things_m, Life::kMostRoom_m);
  EXPECT_EQ(sim.simulator->room().to_people_m, Life::kMostRoom_m);
}

TEST(Simulator, SaysWhatTheRobotIsPressedTo) {
  World world = bare_room();
  world.furniture.push_back(box_at(2.6, 3.0, 0.2, 0.0, 0.07));
  SteppedSim sim(world);
  EXPECT_FALSE(sim.simulator->touched());
  sim.drive({0.4, 0.4}, 0.0, 2.0);
  ASSERT_TRUE(sim.simulator->touched());
  EXPECT_EQ(sim.simulator->touched()->high_m, 0.07);
}

/// Between two thin boards as far apart as it is wide, askew.
TEST(Simulator, WhereTheRobotIsWedgedInTheFloorBeginsBesideIt) {
  World world = bare_room();
  world.world_T_start.yaw = kPi / 8;
  const Vector2 along = unit(kPi / 8), across(-along.y(), along.x());
  for (const double side : {-1.0, 1.0}) {
    Wall board;
    const Vector2 middle = world.world_T_start.translation() + side * 0.13 * across;
    board.points = {middle - 0.05 * along, middle + 0.05 * along};
    board.thickness_m = 0.02;
    world.walls.push_back(board);
  }
  SteppedSim sim(world);
  EXPECT_GT(sim.simulator->reachable_floor(0.1).size(), 4000U);
}

TEST(Simulator, ADoorGoesByWhoMovesItRatherThanByItsSchedule) {
  World world = bare_room();
  world.walls.push_back({{{4, 0}, {4, 2.5}}});
  world.walls.push_back({{{4, 3.5}, {4, 6}}});
  Door door;
  door.hinge = {4, 2.5};
  door.latch = {4, 3.5};
  door.opens_rad = -1.6;
  door.schedule = {{3.0, 1.0}};
  world.doors.push_back(door);
  SteppedSim sim(world);
  const auto all = sim.simulator->reachable_floor(0.1).size();
  sim.simulator->move_door(0, 0.0);
  sim.go_to(2.0);
  const auto half = sim.simulator->reachable_floor(0.1).size();
  EXPECT_LT(half, 0.6 * static_cast<double>(all));
  sim.go_to(6.0);
  EXPECT_EQ(sim.simulator->reachable_floor(0.1).size(), half);
  sim.simulator->move_door(0, 1.0);
  sim.go_to(8.0);
  EXPECT_EQ(sim.simulator->reachable_floor(0.1).size(), all);
}

TEST(Simulator, UnderARunningClockADeviceWaitsForItsSample) {
  const RunningClock clock(time_at_s(10), 5.0);
  auto simulator = std::make_shared<Simulator>(bare_room(), clock, 1);
  const Devices devices = make_devices(simulator);
  const auto sample = devices.imu->next(clock.now() + 2s);
  ASSERT_TRUE(sample.has_value());
  EXPECT_LE(sample->stamp + ImuModel::kDelivery, clock.now());
  simulator->set_fault(SimDevice::kImu, FaultKind::kSilent);
  const Time until = clock.now() + 200ms;
  EXPECT_FALSE(devices.imu->next(until).has_value());
  EXPECT_GE(clock.now(), until);
}

TEST(Simulator, AFaultReachesWhoWaits) {
  const RunningClock clock;
  auto simulator = std::make_shared<Simulator>(bare_room(), clock, 1);
  const Devices devices = make_devices(simulator);
  simulator->set_fault(SimDevice::kLidar, FaultKind::kSilent);
  std::thread puller([&] { simulator->set_fault(SimDevice::kLidar, FaultKind::kUnplugged); });
  EXPECT_THROW(devices.lidar->next(clock.now() + 60s), DeviceError);
  puller.join();
}

}  // namespace
}  // namespace dynslam
