// SPDX-License-Identifier: MIT
#include "robot/autopilot_stage.h"

#include <functional>
#include <memory>

#include <gmock/gmock.h>

#include "robot/robot.h"
#include "sim/small_world.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;

/// A board that does as it is told, and wheels that grip nothing.
class SlippingMotors : public Motors {
 public:
  void drive(const WheelPower&) override {}
  MotorState read() override { return {12.4, false, false, true}; }
};

struct SelfDriving {
  explicit SelfDriving(bool slips = false) : robot(devices(slips), {}, sim.clock) {}

  Devices devices(bool slips) const {
    Devices all = make_devices(sim.simulator);
    if (slips) all.motors = std::make_unique<SlippingMotors>();
    return all;
  }
  Ports& ports() { return robot.ports(); }
  AutopilotStatus status() { return *ports().autopilot.get().value; }
  /// Steps of 10 ms, until `done`; returns how long that took.
  double step_until(const std::function<bool()>& done, double most_s) {
    const Time begin = sim.clock.now();
    do {
      sim.clock.set(sim.clock.now() + milliseconds(10));
      robot.step();
    } while (!done() && sim.clock.now() - begin < from_seconds(most_s));
    return to_seconds(sim.clock.now() - begin);
  }
  /// Whether it drives soon after it is told to.
  bool sets_out(const Destination& to) {
    step_until([&] { return ports().world.get().value != nullptr; }, 2.0);
    ports().orders.push(GoThere{to});
    step_until([&] { return moves(); }, 5.0);
    return moves();
  }
  bool moves() { return is_moving(ports().drive.get().value->applied); }

  SteppedSim sim{bare_room()};
  Robot robot;
};

TEST(AutopilotStage, DrivesThereAndLetsGoOfTheWheel) {
  SelfDriving r;
  ASSERT_TRUE(r.sets_out({{1.0, 0.3}, 1.0}));
  r.step_until([&] { return r.status().phase == AutopilotPhase::kIdle; }, 30.0);
  EXPECT_EQ(r.status().reason, "arrived");
  r.step_until([] { return false; }, 0.5);
  const Pose2 pose = r.ports().world.get().value->pose.map_T_robot;
  EXPECT_NEAR(pose.x, 1.0, 0.05);
  EXPECT_NEAR(pose.y, 0.3, 0.05);
  EXPECT_NEAR(pose.yaw, 1.0, 0.09);
  EXPECT_TRUE(r.ports().command.get().value->gone);
}

TEST(AutopilotStage, WhoTakesTheWheelHasItFromHisFirstCommandOn) {
  SelfDriving r;
  ASSERT_TRUE(r.sets_out({{2.0, 0.0}}));
  const Twist pushed{-0.2, 0.0};
  for (int i = 0; i < 10; ++i) {
    const std::uint64_t seq = r.ports().command.get().value->seq + 1;
    r.ports().command.put({seq, pushed, r.sim.clock.now()});
    for (int tick = 0; tick < 5; ++tick) {
      r.step_until([] { return true; }, 1.0);
      EXPECT_EQ(r.ports().command.get().value->seq, seq) << "command " << i << ", tick " << tick;
    }
  }
  EXPECT_EQ(r.status().phase, AutopilotPhase::kOff);
  EXPECT_EQ(r.status().reason, "a person took the wheel");
}

TEST(AutopilotStage, AnotherOrderAfterThatIsObeyed) {
  SelfDriving r;
  ASSERT_TRUE(r.sets_out({{2.0, 0.0}}));
  r.ports().command.put({r.ports().command.get().value->seq + 1, {0.1, 0.0}, r.sim.clock.now()});
  r.step_until([&] { return r.status().phase == AutopilotPhase::kOff; }, 1.0);
  ASSERT_EQ(r.status().phase, AutopilotPhase::kOff);
  r.step_until([&] { return !r.moves(); }, 2.0);
  EXPECT_TRUE(r.sets_out({{1.0, 0.0}}));
}

TEST(AutopilotStage, NoticesWheelsThatSlipWithinThreeSeconds) {
  SelfDriving r(true);
  ASSERT_TRUE(r.sets_out({{2.0, 0.0}}));
  const double noticed_s = r.step_until(
      [&] { return r.status().reason.starts_with("the wheels turn and the robot stays"); }, 20.0);
  EXPECT_LT(noticed_s, 3.0);
  r.step_until([&] { return r.status().phase == AutopilotPhase::kStopped; }, 30.0);
  EXPECT_EQ(r.status().phase, AutopilotPhase::kStopped) << "backing off does not help for ever";
  EXPECT_EQ(r.status().reason, "the wheels turn and the robot stays");
}

TEST(AutopilotStage, AStopInMidDriveStandsAndClearingItDoesNotSetItOff) {
  SelfDriving r;
  ASSERT_TRUE(r.sets_out({{2.0, 0.0}}));
  r.ports().stops.push("stopped by a test");
  r.step_until([&] { return r.status().phase == AutopilotPhase::kStopped; }, 1.0);
  EXPECT_EQ(r.status().phase, AutopilotPhase::kStopped);
  r.ports().clear_asked = true;
  r.step_until([&] { return r.moves(); }, 3.0);
  EXPECT_FALSE(r.moves());
}

TEST(AutopilotStage, AStopThatIsClearedBeforeTheNextPlanEndsTheErrandToo) {
  SelfDriving r;
  ASSERT_TRUE(r.sets_out({{2.0, 0.0}}));
  const Time planned = r.status().time;
  r.step_until([&] { return r.status().time != planned; }, 1.0);
  r.ports().stops.push("stopped by a test");
  r.step_until([] { return false; }, 0.12);
  r.ports().clear_asked = true;
  r.step_until([] { return false; }, 3.0);
  EXPECT_FALSE(r.moves());
  EXPECT_EQ(r.status().phase, AutopilotPhase::kStopped);
  EXPECT_THAT(r.status().reason, testing::HasSubstr("stopped by a test"));
  EXPECT_TRUE(r.sets_out({{2.0, 0.0}})) << "another order is obeyed";
}

}  // namespace
}  // namespace dynslam
