// SPDX-License-Identifier: MIT
#include "robot/robot.h"

#include <algorithm>
#include <atomic>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robot/fake_devices.h"
#include "sim/small_world.h"

namespace dynslam {
namespace {

using ::testing::HasSubstr;

constexpr Duration kStep = std::chrono::milliseconds(10);

/// A robot in a bare room, step by step, driven by commands 20 times a second.
struct SteppedRobot {
  explicit SteppedRobot(World world = bare_room())
      : sim(std::move(world)), robot(make_devices(sim.simulator), {}, sim.clock) {}

  /// Goes on for a while, commanding `twist`, or nothing at all.
  void go_on(double seconds, const std::optional<Twist>& twist) {
    const Time end = sim.clock.now() + from_seconds(seconds);
    while (sim.clock.now() < end) {
      sim.clock.set(sim.clock.now() + kStep);
      if (twist && sim.clock.now() >= next_command) {
        robot.ports().command.put({++seq, *twist, sim.clock.now()});
        next_command = sim.clock.now() + std::chrono::milliseconds(50);
      }
      robot.step();
    }
  }
  /// Lets go, so that the heartbeat is steady and the next push counts.
  void stand() { go_on(1.0, Twist{}); }
  DriveState drive() { return *robot.ports().drive.get().value; }
  double speed_mps() { return sim.simulator->truth().twist.v_mps; }

  SteppedSim sim;
  Robot robot;
  Time next_command;
  std::uint64_t seq = 0;
};

TEST(Robot, DrivesAsCommandedAndKnowsWhereItIs) {
  SteppedRobot r;
  r.stand();
  r.go_on(4.0, Twist{0.5, 0.0});
  EXPECT_EQ(r.drive().verdict.motion, Motion::kGo) << r.drive().verdict.reason;
  EXPECT_NEAR(r.speed_mps(), 0.45, 0.1);
  const auto world = r.robot.ports().world.get().value;
  ASSERT_TRUE(world);
  const Pose2 truth = r.sim.simulator->world().world_T_start.inverse() *
                      r.sim.simulator->true_pose(world->pose.stamp).value();
  EXPECT_NEAR(world->pose.map_T_robot.x, truth.x, 0.02);
  EXPECT_NEAR(world->pose.map_T_robot.y, truth.y, 0.02);
  EXPECT_GT(truth.x, 1.0);
  EXPECT_GT(world->map.chunk_count(), 10U);
}

TEST(Robot, StopsWhenNothingIsHeard) {
  SteppedRobot r;
  r.stand();
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) {
    r.go_on(0.7 + 0.001 * static_cast<double>(random() % 100), Twist{0.0, 1.0});
    ASSERT_NE(r.drive().power, WheelPower{}) << i;
    r.go_on(0.22 + 0.01, std::nullopt);
    EXPECT_EQ(r.drive().power, WheelPower{}) << i;
    EXPECT_EQ(r.drive().verdict.motion, Motion::kStop);
    r.stand();
  }
}

TEST(Robot, DoesNotGoOnAfterALossUntilTheDriverLetsGo) {
  SteppedRobot r;
  r.stand();
  r.go_on(1.0, Twist{0.3, 0.0});
  r.go_on(0.5, std::nullopt);
  r.go_on(2.0, Twist{0.3, 0.0});
  EXPECT_EQ(r.drive().power, WheelPower{}) << "the stick was held all along";
  r.stand();
  r.go_on(1.0, Twist{0.3, 0.0});
  EXPECT_NE(r.drive().power, WheelPower{});
}

TEST(Robot, StandsBeforeAWall) {
  SteppedRobot r;
  r.stand();
  r.go_on(30.0, Twist{0.8, 0.0});
  EXPECT_EQ(r.drive().verdict.motion, Motion::kHold);
  EXPECT_THAT(r.drive().verdict.reason, HasSubstr("ahead"));
  const SimTruth truth = r.sim.simulator->truth();
  EXPECT_EQ(truth.contacts, 0);
  EXPECT_GT(truth.world_T_robot.x, 7.0);
  r.go_on(2.0, Twist{-0.3, 0.0});
  EXPECT_LT(r.speed_mps(), -0.1) << "the way back is open";
}

TEST(Robot, StopIsLatchedUntilAPersonClearsIt) {
  SteppedRobot r;
  r.stand();
  r.go_on(1.0, Twist{0.3, 0.0});
  for (int i = 0; i < 100; ++i) r.robot.ports().stops.push("somebody");
  r.go_on(0.05, Twist{0.3, 0.0});
  EXPECT_EQ(r.drive().power, WheelPower{});
  r.stand();
  r.go_on(1.0, Twist{0.3, 0.0});
  EXPECT_EQ(r.drive().verdict.motion, Motion::kEStop);
  EXPECT_THAT(r.drive().verdict.reason, HasSubstr("somebody"));
  r.robot.ports().clear_asked = true;
  r.stand();
  r.go_on(1.0, Twist{0.3, 0.0});
  EXPECT_NE(r.drive().power, WheelPower{});
}

struct FaultCase {
  SimDevice device;
  FaultKind kind;
  Motion verdict;
};

class RobotWithAFault : public ::testing::TestWithParam<FaultCase> {};

TEST_P(RobotWithAFault, ReachesTheRightVerdictAndRecovers) {
  const FaultCase& c = GetParam();
  SteppedRobot r;
  r.stand();
  r.go_on(1.0, Twist{0.0, 0.5});
  r.sim.simulator->set_fault(c.device, c.kind);
  r.go_on(1.2, Twist{0.0, 0.5});
  EXPECT_EQ(r.drive().verdict.motion, c.verdict) << r.drive().verdict.reason;
  EXPECT_FALSE(r.drive().verdict.reason.empty());
  EXPECT_EQ(r.drive().power == WheelPower{}, c.verdict >= Motion::kStop);
  r.go_on(1.0, Twist{0.0, 0.5});
  r.sim.simulator->clear_fault(c.device);
  r.go_on(2.0, Twist{});
  r.go_on(1.0, Twist{0.0, 0.5});
  EXPECT_LE(r.drive().verdict.motion, Motion::kSlow) << r.drive().verdict.reason;
  EXPECT_NE(r.drive().power, WheelPower{});
}

INSTANTIATE_TEST_SUITE_P(Each, RobotWithAFault,
                         ::testing::Values(FaultCase{SimDevice::kLidar, FaultKind::kUnplugged, Motion::kStop},
                                           FaultCase{SimDevice::kLidar, FaultKind::kSilent, Motion::kStop},
                                           FaultCase{SimDevice::kLidar, FaultKind::kFrozen, Motion::kStop},
                                           FaultCase{SimDevice::kLidar, FaultKind::kDelayed, Motion::kStop},
                                           FaultCase{SimDevice::kLidar, FaultKind::kNan, Motion::kStop},
                                           FaultCase{SimDevice::kImu, FaultKind::kUnplugged, Motion::kSlow},
                                           FaultCase{SimDevice::kImu, FaultKind::kSilent, Motion::kSlow},
                                           FaultCase{SimDevice::kImu, FaultKind::kFrozen, Motion::kSlow},
                                           FaultCase{SimDevice::kImu, FaultKind::kNan, Motion::kSlow},
                                           FaultCase{SimDevice::kMotors, FaultKind::kUnplugged,
                                                     Motion::kStop},
                                           FaultCase{SimDevice::kMotors, FaultKind::kSilent, Motion::kStop},
                                           FaultCase{SimDevice::kPins, FaultKind::kUnplugged, Motion::kStop},
                                           FaultCase{SimDevice::kPins, FaultKind::kSilent, Motion::kStop}));

TEST(Robot, TheRestGoesOnWhenEverythingFailsTogether) {
  SteppedRobot r;
  for (const SimDevice d : {SimDevice::kLidar, SimDevice::kImu, SimDevice::kMotors, SimDevice::kPins})
    r.sim.simulator->set_fault(d, FaultKind::kUnplugged);
  r.go_on(2.0, Twist{0.3, 0.0});
  EXPECT_EQ(r.drive().power, WheelPower{});
  EXPECT_GE(r.drive().verdict.motion, Motion::kStop);
  EXPECT_FALSE(r.robot.ports().lidar_health.get().value->trouble.empty());
  for (const SimDevice d : {SimDevice::kLidar, SimDevice::kImu, SimDevice::kMotors, SimDevice::kPins})
    r.sim.simulator->clear_fault(d);
  r.go_on(2.0, Twist{});
  r.go_on(1.0, Twist{0.3, 0.0});
  EXPECT_NE(r.drive().power, WheelPower{}) << r.drive().verdict.reason;
  EXPECT_TRUE(r.robot.ports().lidar_health.get().value->trouble.empty());
}

TEST(Robot, TheEStopPinIsLatched) {
  SteppedRobot r;
  r.stand();
  r.go_on(1.0, Twist{0.3, 0.0});
  r.sim.simulator->press_estop(true);
  r.go_on(0.05, Twist{0.3, 0.0});
  EXPECT_EQ(r.drive().verdict.motion, Motion::kEStop);
  EXPECT_EQ(r.drive().power, WheelPower{});
  r.sim.simulator->press_estop(false);
  r.go_on(1.0, Twist{});
  r.go_on(1.0, Twist{0.3, 0.0});
  EXPECT_EQ(r.drive().power, WheelPower{}) << "released, but not cleared";
}

TEST(Robot, TwoRunsAreTheSameToTheBit) {
  std::vector<Pose2> poses[2];
  for (auto& path : poses) {
    SteppedRobot r;
    r.robot.on_scan([&](const ScanResult& scan) { path.push_back(scan.map_T_robot); });
    r.stand();
    r.go_on(3.0, Twist{0.4, 0.3});
  }
  ASSERT_GT(poses[0].size(), 30U);
  EXPECT_EQ(poses[0], poses[1]);
}

// ---- with threads ----

struct LiveRobot {
  explicit LiveRobot(std::unique_ptr<Lidar> lidar = nullptr) {
    Devices devices;
    devices.lidar = lidar ? std::move(lidar) : std::make_unique<FakeLidar>(clock);
    auto fake = std::make_unique<FakeMotors>(clock);
    motors = fake.get();
    devices.motors = std::move(fake);
    robot = std::make_unique<Robot>(std::move(devices), RobotConfig{}, clock);
  }
  /// Waits until the control says so, 5 s at the most.
  template <class Is>
  bool wait_until(Is&& is) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    std::uint64_t seen = 0;
    while (std::chrono::steady_clock::now() < end) {
      const auto item = robot->ports().drive.wait(seen, end);
      seen = item.version;
      if (item.value && is(*item.value)) return true;
    }
    return false;
  }
  void command(const Twist& twist) { robot->ports().command.put({++seq, twist, clock.now()}); }
  /// Commands 20 times a second until the robot does as it is told.
  bool drive(const Twist& twist) {
    Time next;
    return wait_until([&](const DriveState& d) {
      if (d.time >= next) {
        command(twist);
        next = d.time + std::chrono::milliseconds(50);
      }
      return (d.power != WheelPower{}) == is_moving(twist) && d.verdict.motion < Motion::kStop;
    });
  }

  RunningClock clock{time_at_s(100)};
  FakeMotors* motors = nullptr;
  std::unique_ptr<Robot> robot;
  std::uint64_t seq = 0;
};

TEST(LiveRobot, StandsStillLast) {
  LiveRobot r;
  r.robot->start();
  ASSERT_TRUE(r.drive({}));
  ASSERT_TRUE(r.drive({0.0, 1.0}));
  const auto begun = std::chrono::steady_clock::now();
  const Robot::Ending ending = r.robot->stop();
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(1));
  EXPECT_FALSE(ending.hangs);
  EXPECT_EQ(ending.trouble, "");
  EXPECT_EQ(r.motors->calls().back().power, WheelPower{});
}

TEST(LiveRobot, ADeviceThatThrowsWhatItMustNotEndsTheRobotAndNotTheProgram) {
  std::atomic<int> scans = 0;
  LiveRobot r(std::make_unique<PuppetLidar>([&](Time) -> std::optional<Scan> {
    if (++scans > 3) throw std::logic_error("a bug in the driver");
    return std::nullopt;
  }));
  r.robot->start();
  EXPECT_TRUE(r.robot->wait(std::chrono::steady_clock::now() + std::chrono::seconds(5)));
  EXPECT_THAT(r.robot->stop().trouble, HasSubstr("lidar: a bug in the driver"));
  EXPECT_EQ(r.motors->calls().back().power, WheelPower{});
}

TEST(LiveRobot, SaysWhenADeviceHangs) {
  std::mutex mutex;
  std::condition_variable changed;
  bool hangs = false, free = false;
  LiveRobot r(std::make_unique<PuppetLidar>([&](Time) -> std::optional<Scan> {
    std::unique_lock lock(mutex);
    hangs = true;
    changed.notify_all();
    changed.wait(lock, [&] { return free; });
    return std::nullopt;
  }));
  r.robot->start();
  ASSERT_TRUE(r.wait_until([](const DriveState& d) { return d.verdict.motion == Motion::kStop; }));
  {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return hangs; });
  }
  EXPECT_TRUE(r.robot->stop(std::chrono::milliseconds(100)).hangs);
  EXPECT_EQ(r.motors->calls().back().power, WheelPower{}) << "all the same";
  {
    const std::lock_guard lock(mutex);
    free = true;
  }
  changed.notify_all();
  EXPECT_FALSE(r.robot->stop(std::chrono::seconds(5)).hangs);
}

TEST(LiveRobot, MotorsAreOffSoonAfterTheLastHeartbeat) {
  LiveRobot r;
  r.robot->start();
  std::vector<double> off_ms;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(r.drive({})) << i;
    ASSERT_TRUE(r.drive({0.0, 1.0})) << i;
    const Time last = r.robot->ports().command.get().value->heard;
    ASSERT_TRUE(r.wait_until([](const DriveState& d) { return d.power == WheelPower{}; }));
    off_ms.push_back(1e3 * to_seconds(r.motors->calls().back().at - last));
  }
  std::sort(off_ms.begin(), off_ms.end());
  std::printf("from the last heartbeat to motors off, ms: least %.0f, median %.0f, most %.0f\n",
              off_ms.front(), off_ms[off_ms.size() / 2], off_ms.back());
  EXPECT_GE(off_ms.front(), 199.0);
  EXPECT_LT(off_ms.back(), 400.0);
}

TEST(LiveRobot, LoopsAreClosedInAThreadOfTheirOwn) {
  RunningClock clock(Time(), 10.0);
  auto simulator = std::make_shared<Simulator>(bare_room(), clock, 1);
  Robot robot(make_devices(simulator), {}, clock);
  robot.start();
  std::uint64_t seq = 0, seen = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  double way_m = 0.0;
  for (std::size_t n = 0; way_m < 20.0 && std::chrono::steady_clock::now() < end; ++n) {
    const auto item = robot.ports().drive.wait(seen, end);
    seen = item.version;
    const bool let_go = item.value && item.value->verdict.motion >= Motion::kStop;
    robot.ports().command.put({++seq, let_go ? Twist{} : Twist{0.6, 0.5}, clock.now()});
    way_m = simulator->truth().distance_m;
  }
  EXPECT_FALSE(robot.stop(std::chrono::seconds(5)).hangs);
  robot.finish();
  EXPECT_GE(way_m, 20.0);
  EXPECT_GT(robot.slam().back_end().loops().closures(), 0U);
  EXPECT_EQ(robot.counters()["queue.local_maps_dropped"], 0U);
}

}  // namespace
}  // namespace dynslam
