// SPDX-License-Identifier: MIT
// How simulated devices misbehave.
#include <gtest/gtest.h>

#include "base/error.h"
#include "device/device_error.h"
#include "sim/small_world.h"

namespace dynslam {
namespace {

using namespace std::chrono_literals;

/// An east wall nearer than the rest, so that left and right can be told apart.
World lopsided() {
  World world = bare_room();
  world.furniture.push_back(box_at(2, 5, 0.6, 0, 1));
  return world;
}

std::optional<Scan> newest(SteppedSim& sim) {
  std::optional<Scan> last;
  while (auto scan = sim.devices.lidar->next(sim.clock.now())) last = std::move(scan);
  return last;
}

TEST(Faults, WhatIsUnpluggedThrowsAndComesBackWithoutOldSamples) {
  SteppedSim sim(bare_room());
  for (const SimDevice d :
       {SimDevice::kLidar, SimDevice::kImu, SimDevice::kMotors, SimDevice::kCamera, SimDevice::kPins}) {
    sim.simulator->set_fault(d, FaultKind::kUnplugged);
  }
  sim.go_to(1.0);
  const Time now = sim.clock.now();
  EXPECT_THROW(sim.devices.lidar->next(now), DeviceError);
  EXPECT_THROW(sim.devices.imu->next(now), DeviceError);
  EXPECT_THROW(sim.devices.camera->next(now), DeviceError);
  EXPECT_THROW(sim.devices.motors->drive({}), DeviceError);
  EXPECT_THROW(sim.devices.motors->read(), DeviceError);
  EXPECT_THROW(sim.devices.pins->read(), DeviceError);
  sim.simulator->clear_fault(SimDevice::kLidar);
  EXPECT_FALSE(sim.devices.lidar->next(now).has_value());
  sim.go_to(1.11);
  EXPECT_EQ(sim.devices.lidar->next(sim.clock.now())->stamp, sim.begin + 1s);
}

TEST(Faults, UnpluggedMotorsStopByTheirFailsafe) {
  SteppedSim sim(bare_room());
  sim.drive({0.4, 0.4}, 0.0, 1.0);
  sim.simulator->set_fault(SimDevice::kMotors, FaultKind::kUnplugged);
  sim.go_to(2.5);
  EXPECT_LT(sim.simulator->truth().twist.v_mps, 0.01);
}

TEST(Faults, AFrozenLidarRepeatsItselfWithNewStamps) {
  SteppedSim sim(bare_room());
  sim.drive({0.4, 0.4}, 0.0, 1.0);
  const Scan before = *newest(sim);
  sim.simulator->set_fault(SimDevice::kLidar, FaultKind::kFrozen);
  sim.drive({0.4, 0.4}, 1.0, 2.0);
  const Scan frozen = *newest(sim);
  EXPECT_EQ(frozen.stamp - before.stamp, 1s);
  for (std::size_t i = 0; i < before.beams.size(); ++i)
    ASSERT_EQ(frozen.beams[i].range_m, before.beams[i].range_m);
}

TEST(Faults, AFrozenMotorBoardHeedsNothing) {
  SteppedSim sim(bare_room());
  const double volts = sim.devices.motors->read().battery_v;
  sim.simulator->set_fault(SimDevice::kMotors, FaultKind::kFrozen);
  sim.drive({0.4, 0.4}, 0.0, 1.0);
  EXPECT_EQ(sim.simulator->truth().distance_m, 0.0);
  sim.simulator->set_battery(0.1);
  sim.go_to(1.5);
  EXPECT_EQ(sim.devices.motors->read().battery_v, volts);
}

TEST(Faults, ASilentDeviceSaysNothing) {
  SteppedSim sim(bare_room());
  sim.simulator->set_fault(SimDevice::kLidar, FaultKind::kSilent);
  sim.simulator->set_fault(SimDevice::kMotors, FaultKind::kSilent);
  sim.go_to(1.0);
  EXPECT_FALSE(sim.devices.lidar->next(sim.clock.now()).has_value());
  EXPECT_THROW(sim.devices.motors->drive({1, 1}), DeviceError);
}

TEST(Faults, ADelayedDeviceComesLateWithItsTrueStamp) {
  SteppedSim sim(bare_room());
  sim.simulator->set_fault(SimDevice::kLidar, FaultKind::kDelayed);
  sim.go_to(0.6);
  EXPECT_FALSE(sim.devices.lidar->next(sim.clock.now()).has_value());
  sim.go_to(0.61);
  EXPECT_EQ(sim.devices.lidar->next(sim.clock.now())->stamp, sim.begin);
}

TEST(Faults, DelayedMotorsMoveLate) {
  SteppedSim sim(bare_room());
  sim.simulator->set_fault(SimDevice::kMotors, FaultKind::kDelayed);
  sim.drive({0.4, 0.4}, 0.0, 0.5);
  EXPECT_EQ(sim.simulator->truth().distance_m, 0.0);
  sim.drive({0.4, 0.4}, 0.5, 1.0);
  EXPECT_GT(sim.simulator->truth().distance_m, 0.1);
}

TEST(Faults, WrongNumbers) {
  SteppedSim sim(bare_room());
  sim.simulator->set_fault(SimDevice::kLidar, FaultKind::kNan);
  sim.simulator->set_fault(SimDevice::kImu, FaultKind::kInfinite);
  sim.simulator->set_fault(SimDevice::kMotors, FaultKind::kNan);
  sim.go_to(0.2);
  EXPECT_TRUE(std::isnan(sim.devices.lidar->next(sim.clock.now())->beams[7].range_m));
  EXPECT_TRUE(std::isinf(sim.devices.imu->next(sim.clock.now())->world_q_robot.w()));
  EXPECT_TRUE(std::isnan(sim.devices.motors->read().battery_v));
}

TEST(Faults, AMirroredLidarSwapsLeftAndRight) {
  SteppedSim sim(lopsided());
  sim.go_to(0.2);
  EXPECT_NEAR(median_range(*newest(sim), kPi / 2), 1.7, 0.05);
  sim.simulator->set_fault(SimDevice::kLidar, FaultKind::kMirrored);
  sim.go_to(0.4);
  EXPECT_NEAR(median_range(*newest(sim), -kPi / 2), 1.7, 0.05);
}

TEST(Faults, AMirroredImuTurnsTheOtherWay) {
  SteppedSim sim(bare_room());
  sim.simulator->set_fault(SimDevice::kImu, FaultKind::kMirrored);
  sim.drive({-0.25, 0.25}, 0.0, 0.5);
  std::vector<double> yaws;
  while (auto sample = sim.devices.imu->next(sim.clock.now())) yaws.push_back(yaw_of(sample->world_q_robot));
  ASSERT_GT(yaws.size(), 40U);
  EXPECT_GT(sim.simulator->truth().world_T_robot.yaw, 0.2);
  EXPECT_LT(turn(yaws[2], yaws[yaws.size() - 2]), -0.15);
}

TEST(Faults, TheWorldsScheduleHoldsUnlessCommandedOtherwise) {
  World world = bare_room();
  world.faults.push_back({SimDevice::kPins, FaultKind::kUnplugged, 1.0, 2.0});
  SteppedSim sim(world);
  EXPECT_NO_THROW(sim.devices.pins->read());
  sim.go_to(1.0);
  EXPECT_THROW(sim.devices.pins->read(), DeviceError);
  sim.simulator->set_fault(SimDevice::kPins, FaultKind::kFrozen);
  EXPECT_NO_THROW(sim.devices.pins->read());
  sim.simulator->clear_fault(SimDevice::kPins);
  EXPECT_THROW(sim.devices.pins->read(), DeviceError);
  sim.go_to(2.0);
  EXPECT_NO_THROW(sim.devices.pins->read());
}

TEST(Faults, ADeviceCannotHaveEachOfThem) {
  SteppedSim sim(bare_room());
  EXPECT_THROW(sim.simulator->set_fault(SimDevice::kPins, FaultKind::kNan), InputError);
  EXPECT_THROW(sim.simulator->set_fault(SimDevice::kMotors, FaultKind::kMirrored), InputError);
  for (std::size_t i = 0; i < kFaultNames.size(); ++i) {
    EXPECT_EQ(fault_kind_of(kFaultNames[i]), static_cast<FaultKind>(i));
  }
  EXPECT_FALSE(fault_kind_of("tired").has_value());
  EXPECT_EQ(sim_device_of("camera"), SimDevice::kCamera);
}

}  // namespace
}  // namespace dynslam
