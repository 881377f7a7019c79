// SPDX-License-Identifier: MIT
#include "robot/robot.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <random>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robot/fake_devices.h"
#include "sim/small_world.h"

namespace dynslam {
namespace {

using ::testing::HasSubstr;

constexpr Duration kStep = std::chrono::milliseconds(10);
#ifdef DYNSLAM_SLOWED  // by a sanitizer, or an emulated processor
constexpr double kTimesFaster = 1.5;
#else
constexpr double kTimesFaster = 10.0;
#endif

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

/// A device that fails, what Safety says to that when it happens on the way, and when it was so from the
/// start. What a frozen board, mirrored data or frozen pins hide, no verdict can tell.
struct FaultCase {
  SimDevice device;
  FaultKind kind;
  Motion on_the_way, from_the_start;
};

constexpr std::array kFaultCases = {
    FaultCase{SimDevice::kLidar, FaultKind::kUnplugged, Motion::kStop, Motion::kStop},
    FaultCase{SimDevice::kLidar, FaultKind::kSilent, Motion::kStop, Motion::kStop},
    FaultCase{SimDevice::kLidar, FaultKind::kFrozen, Motion::kStop, Motion::kStop},
    FaultCase{SimDevice::kLidar, FaultKind::kDelayed, Motion::kStop, Motion::kStop},
    FaultCase{SimDevice::kLidar, FaultKind::kNan, Motion::kStop, Motion::kStop},
    FaultCase{SimDevice::kLidar, FaultKind::kInfinite, Motion::kStop, Motion::kStop},
    FaultCase{SimDevice::kLidar, FaultKind::kMirrored, Motion::kGo, Motion::kGo},
    FaultCase{SimDevice::kImu, FaultKind::kUnplugged, Motion::kSlow, Motion::kSlow},
    FaultCase{SimDevice::kImu, FaultKind::kSilent, Motion::kSlow, Motion::kSlow},
    FaultCase{SimDevice::kImu, FaultKind::kFrozen, Motion::kSlow, Motion::kSlow},
    FaultCase{SimDevice::kImu, FaultKind::kDelayed, Motion::kSlow, Motion::kSlow},
    FaultCase{SimDevice::kImu, FaultKind::kNan, Motion::kSlow, Motion::kSlow},
    FaultCase{SimDevice::kImu, FaultKind::kInfinite, Motion::kSlow, Motion::kSlow},
    FaultCase{SimDevice::kImu, FaultKind::kMirrored, Motion::kGo, Motion::kGo},
    FaultCase{SimDevice::kMotors, FaultKind::kUnplugged, Motion::kStop, Motion::kStop},
    FaultCase{SimDevice::kMotors, FaultKind::kSilent, Motion::kStop, Motion::kStop},
    FaultCase{SimDevice::kMotors, FaultKind::kFrozen, Motion::kGo, Motion::kGo},
    FaultCase{SimDevice::kMotors, FaultKind::kDelayed, Motion::kGo, Motion::kGo},
    FaultCase{SimDevice::kMotors, FaultKind::kNan, Motion::kGo, Motion::kGo},
    FaultCase{SimDevice::kMotors, FaultKind::kInfinite, Motion::kGo, Motion::kGo},
    FaultCase{SimDevice::kPins, FaultKind::kUnplugged, Motion::kStop, Motion::kStop},
    FaultCase{SimDevice::kPins, FaultKind::kSilent, Motion::kStop, Motion::kStop},
    FaultCase{SimDevice::kPins, FaultKind::kFrozen, Motion::kGo, Motion::kGo},
    FaultCase{SimDevice::kPins, FaultKind::kDelayed, Motion::kGo, Motion::kGo},
    FaultCase{SimDevice::kCamera, FaultKind::kUnplugged, Motion::kGo, Motion::kGo},
    FaultCase{SimDevice::kCamera, FaultKind::kFrozen, Motion::kGo, Motion::kGo},
};

/// The longest from a fault that calls for a stop to motors off: the lidar's or the board's time-out, a tick,
/// and what is read only so often.
constexpr Duration kOffWithin = std::chrono::milliseconds(650);

class RobotWithAFault : public ::testing::TestWithParam<FaultCase> {
 protected:
  void expect_recovery(SteppedRobot& r) {
    r.sim.simulator->clear_fault(GetParam().device);
    r.go_on(2.5, Twist{});
    r.go_on(1.0, kTurn);
    EXPECT_LE(r.drive().verdict.motion, Motion::kSlow) << r.drive().verdict.reason;
    EXPECT_NE(r.drive().power, WheelPower{});
  }
  const Twist kTurn{0.0, 0.5};
};

TEST_P(RobotWithAFault, ReachesTheRightVerdictOnTheWayAndRecovers) {
  const FaultCase& c = GetParam();
  SteppedRobot r;
  r.stand();
  r.go_on(1.0, kTurn);
  r.sim.simulator->set_fault(c.device, c.kind);
  if (c.on_the_way >= Motion::kStop) {
    r.go_on(to_seconds(kOffWithin), kTurn);
    EXPECT_EQ(r.drive().power, WheelPower{}) << r.drive().verdict.reason;
  }
  r.go_on(1.2, kTurn);
  EXPECT_EQ(r.drive().verdict.motion, c.on_the_way) << r.drive().verdict.reason;
  EXPECT_EQ(r.drive().verdict.reason.empty(), c.on_the_way == Motion::kGo) << r.drive().verdict.reason;
  EXPECT_EQ(r.drive().power == WheelPower{}, c.on_the_way >= Motion::kStop);
  r.go_on(1.0, kTurn);
  expect_recovery(r);
}

TEST_P(RobotWithAFault, ReachesTheRightVerdictFromTheStartAndRecovers) {
  const FaultCase& c = GetParam();
  SteppedRobot r;
  r.sim.simulator->set_fault(c.device, c.kind);
  r.go_on(2.0, Twist{});
  r.go_on(2.0, kTurn);
  EXPECT_EQ(r.drive().verdict.motion, c.from_the_start) << r.drive().verdict.reason;
  EXPECT_EQ(r.drive().power == WheelPower{}, c.from_the_start >= Motion::kStop);
  expect_recovery(r);
}

INSTANTIATE_TEST_SUITE_P(Each, RobotWithAFault, ::testing::ValuesIn(kFaultCases), [](const auto& fault) {
  const FaultCase& c = fault.param;
  return std::string(kSimDeviceNames[static_cast<std::size_t>(c.device)]) + "_" +
         std::string(kFaultNames[static_cast<std::size_t>(c.kind)]);
});

TEST(Robot, TwoFaultsTogetherAreNoBetterThanTheWorseOfThem) {
  for (const FaultCase& a : kFaultCases) {
    for (const FaultCase& b : kFaultCases) {
      if (a.device >= b.device) continue;
      SteppedRobot r;
      r.stand();
      r.go_on(0.5, Twist{0.0, 0.5});
      r.sim.simulator->set_fault(a.device, a.kind);
      r.sim.simulator->set_fault(b.device, b.kind);
      r.go_on(1.2, Twist{0.0, 0.5});
      const Motion worse = std::max(a.on_the_way, b.on_the_way);
      EXPECT_EQ(r.drive().verdict.motion, worse)
          << kSimDeviceNames[static_cast<std::size_t>(a.device)] << " "
          << kFaultNames[static_cast<std::size_t>(a.kind)] << ", "
          << kSimDeviceNames[static_cast<std::size_t>(b.device)] << " "
          << kFaultNames[static_cast<std::size_t>(b.kind)] << ": " << r.drive().verdict.reason;
    }
  }
}

TEST(Robot, AKickOfAMetreIsNoticed) {
  SteppedRobot r;
  r.stand();
  r.go_on(3.0, Twist{0.4, 0.0});
  ASSERT_TRUE(r.sim.simulator->kick({1.0, 0.8, 0.0}));
  r.go_on(3.0, Twist{});
  const auto error_m = [&] {
    const PoseEstimate pose = r.robot.ports().world.get().value->pose;
    const Pose2 truth =
        r.sim.simulator->world().world_T_start.inverse() * r.sim.simulator->true_pose(pose.stamp).value();
    return pose.lost ? 0.0 : (truth.translation() - pose.map_T_robot.translation()).norm();
  };
  EXPECT_LT(error_m(), 0.1) << "it knows where it is, or that it does not know";
  r.go_on(20.0, Twist{0.0, 0.6});
  EXPECT_LT(error_m(), 0.1);
}

TEST(Robot, GoesEasyOnTheComputersSupply) {
  SteppedRobot r;
  r.stand();
  r.robot.ports().supply_low = true;
  r.go_on(0.5, Twist{0.0, 1.0});
  EXPECT_TRUE(r.drive().battery.brownout);
  EXPECT_THAT(r.drive().verdict.reason, HasSubstr("5 V supply"));
  r.robot.ports().supply_low = false;
  r.go_on(6.0, Twist{0.0, 1.0});
  EXPECT_FALSE(r.drive().battery.brownout);
}

TEST(Robot, AnEmptyBatteryIsToldOfAndGoneEasyOn) {
  SteppedRobot r;
  r.stand();
  r.sim.simulator->set_battery(0.02);
  bool brownout = false, low = false;
  double least_power = 1.0;
  for (int i = 0; i < 200; ++i) {
    r.go_on(0.1, i % 10 < 5 ? Twist{0.0, 3.0} : Twist{0.0, -3.0});
    const DriveState d = r.drive();
    brownout = brownout || d.battery.brownout;
    low = low || d.battery.level == BatteryLevel::kRecharge || d.battery.level == BatteryLevel::kLow;
    if (d.battery.brownout) {
      EXPECT_EQ(d.verdict.motion, Motion::kSlow) << d.verdict.reason;
      EXPECT_THAT(d.verdict.reason, HasSubstr("battery"));
      least_power = std::min(least_power, std::abs(d.power.left));
    }
  }
  EXPECT_TRUE(brownout);
  EXPECT_TRUE(low);
  EXPECT_LT(least_power, 0.7);
  EXPECT_EQ(r.sim.simulator->truth().contacts, 0);
}

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

TEST(Robot, TellsHowItStandsAndTurns) {
  SteppedRobot r;
  r.stand();
  ASSERT_TRUE(r.drive().attitude);
  EXPECT_NEAR(r.drive().attitude->yaw_radps, 0.0, 0.05);
  EXPECT_NEAR(r.drive().attitude->pitch_rad, 0.0, 0.05);
  EXPECT_EQ(r.drive().cause, Cause::kNone);
  EXPECT_EQ(r.drive().collision, false);
  r.go_on(2.0, Twist{0.0, 0.8});
  EXPECT_NEAR(r.drive().attitude->yaw_radps, r.sim.simulator->truth().twist.w_radps, 0.2);
  r.sim.simulator->set_fault(SimDevice::kImu, FaultKind::kUnplugged);
  r.go_on(1.5, Twist{});
  EXPECT_FALSE(r.drive().attitude);
  EXPECT_EQ(r.drive().cause, Cause::kImu);
}

TEST(Robot, TrustsRaysAsFarAsItIsTold) {
  const auto wall_ahead = [](double trusted_m) {
    SteppedRobot r;
    EXPECT_EQ(r.robot.ports().trusted_range_m, SlamConfig{}.trusted_range_m);
    r.robot.ports().trusted_range_m = trusted_m;
    r.stand();
    const GridSnapshot map = r.robot.ports().world.get().value->map;
    bool found = false;
    for (double x = 5.9; x < 6.1; x += 0.01)
      found = found || map.state(cell_at({x, 0.0}, map.cell_size_m())) == CellState::kOccupied;
    return found;
  };
  EXPECT_TRUE(wall_ahead(12.0));
  EXPECT_FALSE(wall_ahead(4.0));
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

/// All cores have something to do while it lives.
class BusyCores {
 public:
  BusyCores() {
    for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
      threads_.emplace_back([this] {
        while (!stop_) ++turns_;
      });
    }
  }
  ~BusyCores() {
    stop_ = true;
    for (std::thread& t : threads_) t.join();
  }

 private:
  std::atomic<bool> stop_ = false;
  std::atomic<std::uint64_t> turns_ = 0;
  std::vector<std::thread> threads_;
};

TEST(LiveRobot, MotorsAreOffSoonAfterTheLastHeartbeatThoughAllCoresAreBusy) {
  const BusyCores busy;
  LiveRobot r;
  r.robot->start();
  std::vector<double> off_ms;
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(r.drive({})) << i;
    ASSERT_TRUE(r.drive({0.0, 1.0})) << i;
    const Time last = r.robot->ports().command.get().value->heard;
    // They may have been off before it, when it came late; it set them going again.
    const auto off_after = [&](const std::vector<FakeMotors::Call>& calls) {
      const auto on = std::find_if(calls.begin(), calls.end(), [&](const FakeMotors::Call& c) {
        return c.at > last && c.power != WheelPower{};
      });
      return std::find_if(on, calls.end(), [](const FakeMotors::Call& c) { return c.power == WheelPower{}; });
    };
    std::vector<FakeMotors::Call> calls;
    ASSERT_TRUE(r.wait_until([&](const DriveState&) {
      calls = r.motors->calls();
      return off_after(calls) != calls.end();
    }));
    const auto off = off_after(calls);
    off_ms.push_back(1e3 * to_seconds(off->at - last));
  }
  std::sort(off_ms.begin(), off_ms.end());
  std::printf("from the last heartbeat to motors off, ms: least %.0f, median %.0f, 90 %% %.0f, most %.0f\n",
              off_ms.front(), off_ms[off_ms.size() / 2], off_ms[off_ms.size() * 9 / 10], off_ms.back());
  EXPECT_GE(off_ms.front(), 199.0);
  EXPECT_LT(off_ms.back(), 400.0);
}

TEST(LiveRobot, LoopsAreClosedInAThreadOfTheirOwn) {
  RunningClock clock(Time(), kTimesFaster);
  auto simulator = std::make_shared<Simulator>(bare_room(), clock, 1);
  Robot robot(make_devices(simulator), {}, clock);
  robot.start();
  std::uint64_t seq = 0, seen = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
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
  const auto graph = robot.ports().graph.get().value;
  ASSERT_TRUE(graph);
  EXPECT_FALSE(graph->local_maps.empty());
  EXPECT_FALSE(graph->closures.empty());
  for (const GraphView::Closure& c : graph->closures) {
    for (const std::uint32_t id : {c.from, c.to})
      EXPECT_TRUE(std::any_of(graph->local_maps.begin(), graph->local_maps.end(),
                              [&](const GraphNode& map) { return map.id == id; }));
  }
}

}  // namespace
}  // namespace dynslam
