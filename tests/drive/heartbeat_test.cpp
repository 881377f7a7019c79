// SPDX-License-Identifier: MIT
#include "drive/heartbeat.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using State = Heartbeat::State;

constexpr Twist kStand{0, 0};
constexpr Twist kForward{0.5, 0};

Time at_ms(int ms) { return Time(milliseconds(ms)); }

/// A driver who sends every 50 ms.
struct Driver {
  Heartbeat heartbeat;
  std::uint64_t seq = 0;
  int ms = 1000;
  DriveCommand last;

  explicit Driver(const HeartbeatConfig& config = {}) : heartbeat(config) {}
  State send(const Twist& twist) {
    last = {++seq, twist, at_ms(ms)};
    return heartbeat.update(at_ms(ms), last);
  }
  State send_for(int duration_ms, const Twist& twist) {
    State state = heartbeat.state();
    for (const int end = ms + duration_ms; ms < end; ms += 50) state = send(twist);
    return state;
  }
  State wait_until(int until_ms) { return heartbeat.update(at_ms(ms = until_ms), last); }
};

/// After half a second of standing still and a push: alive, the last command at 1550 ms.
Driver driving() {
  Driver d;
  d.send_for(550, kStand);
  d.send(kForward);
  return d;
}

TEST(Heartbeat, IsSilentUntilSomethingIsHeard) {
  Heartbeat h;
  EXPECT_EQ(h.update(at_ms(0), {}), State::kSilent);
  EXPECT_FALSE(h.deadline());
  EXPECT_EQ(h.wanted(), kStand);
  EXPECT_EQ(h.reason(), "nobody is driving");
}

TEST(Heartbeat, ObeysAPushAfterSteadyStanding) {
  Driver d;
  EXPECT_EQ(d.send_for(500, kStand), State::kUnsteady) << "the last one came after 450 ms";
  EXPECT_EQ(d.send(kStand), State::kAlive);
  d.ms += 50;
  EXPECT_EQ(d.send(kForward), State::kAlive);
  EXPECT_EQ(d.heartbeat.wanted(), kForward);
  EXPECT_EQ(d.heartbeat.deadline(), at_ms(1550 + 200));
  EXPECT_TRUE(d.heartbeat.reason().empty());
}

TEST(Heartbeat, IsLostAfterTheTimeoutToTheMicrosecond) {
  for (const auto& [after, alive] : {std::pair{microseconds(199'000), true},
                                     {microseconds(199'999), true},
                                     {microseconds(200'000), false},
                                     {microseconds(200'001), false},
                                     {microseconds(201'000), false}}) {
    Driver d = driving();
    const State state = d.heartbeat.update(d.last.heard + after, d.last);
    EXPECT_EQ(state == State::kAlive, alive) << after.count();
    EXPECT_EQ(d.heartbeat.wanted(), alive ? kForward : kStand) << after.count();
  }
}

TEST(Heartbeat, AStickHeldThroughALossDoesNotStartTheRobotAgain) {
  Driver d = driving();
  d.wait_until(1800);
  EXPECT_EQ(d.heartbeat.reason(), "nothing heard from the driver for 0.2 s");
  EXPECT_EQ(d.send_for(5000, kForward), State::kHeld);
  EXPECT_EQ(d.heartbeat.reason(), "let go of the stick, then push again");
  EXPECT_EQ(d.send(kStand), State::kAlive);
  EXPECT_EQ(d.send_for(100, kForward), State::kAlive);
  EXPECT_EQ(d.heartbeat.wanted(), kForward);
}

TEST(Heartbeat, APushBeforeTheConnectionIsSteadyDoesNotCount) {
  Driver d = driving();
  d.wait_until(1800);
  d.send_for(300, kStand);
  EXPECT_EQ(d.send_for(1000, kForward), State::kHeld);
}

TEST(Heartbeat, GapsShorterThanTheTimeoutDoNotDisturbTheDebounce) {
  for (const auto& [gap_ms, alive] : {std::pair{150, true}, {199, true}, {200, false}, {250, false}}) {
    Driver d;
    d.send_for(300, kStand);  // the last one at 1250
    d.ms = 1250 + gap_ms;
    d.send(kStand);
    d.ms = 1510;
    EXPECT_EQ(d.send(kStand) == State::kAlive, alive) << gap_ms;
  }
}

TEST(Heartbeat, AGapThatNobodyLookedIntoIsALossAllTheSame) {
  Driver d = driving();
  d.ms += 200;
  EXPECT_EQ(d.send(kForward), State::kUnsteady);
  EXPECT_EQ(d.heartbeat.wanted(), kStand);
}

TEST(Heartbeat, RefusesNonsenseAndCountsItOnce) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  struct Row {
    DriveCommand command;
    const char* why;
  };
  const Time now = at_ms(1600);
  for (const Row& row :
       {Row{{99, {kNan, 0}, now}, "command not a number"}, Row{{99, {0, kInf}, now}, "command not a number"},
        Row{{99, kForward, now + std::chrono::hours(1)}, "command from the future"},
        Row{{11, kForward, now}, "command out of order"}, Row{{12, kForward, now}, "command out of order"},
        Row{{99, kForward, at_ms(1500)}, "command out of order"}}) {
    Driver d = driving();
    ASSERT_EQ(d.seq, 12U);
    d.heartbeat.update(now, row.command);
    d.heartbeat.update(now, row.command);
    EXPECT_EQ(d.heartbeat.refused()[row.why], 1U) << row.why;
    EXPECT_EQ(d.heartbeat.update(at_ms(1550 + 200), row.command), State::kSilent)
        << row.why << ": a refused command is no sign of life";
  }
}

TEST(Heartbeat, ACommandFromTheFutureIsTakenWhenItsTimeHasCome) {
  Driver d = driving();
  const DriveCommand early{13, {0.2, 0}, at_ms(1601)};
  d.heartbeat.update(at_ms(1600), early);
  EXPECT_EQ(d.heartbeat.wanted(), kForward);
  d.heartbeat.update(at_ms(1601), early);
  EXPECT_EQ(d.heartbeat.wanted(), (Twist{0.2, 0}));
}

TEST(Heartbeat, AnotherDriverMayCountAnewAfterALoss) {
  Driver d = driving();
  d.seq = 0;
  d.ms += 50;
  d.send_for(1000, kStand);
  EXPECT_EQ(d.heartbeat.state(), State::kAlive) << "refused until the first driver timed out, then accepted";
  EXPECT_GT(d.heartbeat.refused()["command out of order"], 0U);
}

TEST(Heartbeat, AClockThatRunsBackwardsIsALoss) {
  Driver d = driving();
  EXPECT_EQ(d.heartbeat.update(d.last.heard + milliseconds(50), d.last), State::kAlive);
  EXPECT_NE(d.heartbeat.update(d.last.heard + milliseconds(49), d.last), State::kAlive);
  EXPECT_EQ(d.heartbeat.wanted(), kStand);
  d.ms = 500;
  EXPECT_NE(d.send_for(450, kForward), State::kAlive);
}

TEST(Heartbeat, AfterAStopTheStickMustBeLetGo) {
  Driver d = driving();
  d.heartbeat.require_release();
  d.ms += 50;
  EXPECT_EQ(d.send_for(1000, kForward), State::kHeld);
  EXPECT_EQ(d.send(kStand), State::kAlive);
}

TEST(Heartbeat, ADriverWhoSaysThatHeIsGoneIsLostAtOnce) {
  Driver d = driving();
  ASSERT_EQ(d.heartbeat.wanted(), kForward);
  d.ms += 10;
  const DriveCommand farewell{++d.seq, {}, at_ms(d.ms), true};
  EXPECT_EQ(d.heartbeat.update(at_ms(d.ms), farewell), State::kSilent);
  EXPECT_EQ(d.heartbeat.wanted(), kStand);
  EXPECT_EQ(d.heartbeat.reason(), "nobody is driving");
  EXPECT_FALSE(d.heartbeat.deadline());
  EXPECT_EQ(d.heartbeat.update(at_ms(d.ms + 20), farewell), State::kSilent);

  d.seq = 0;  // another driver, who counts anew
  d.ms += 20;
  EXPECT_EQ(d.send_for(500, kForward), State::kUnsteady);
  EXPECT_EQ(d.send(kForward), State::kHeld);
  EXPECT_TRUE(d.heartbeat.refused().empty());
}

TEST(Heartbeat, WhoCommandsAfterADriverLeftBeginsAnew) {
  Driver d = driving();
  d.heartbeat.driver_left();
  d.ms += 10;
  EXPECT_EQ(d.send(kForward), State::kUnsteady)
      << "the next one's command goes on in order, and is not obeyed";
  EXPECT_EQ(d.heartbeat.wanted(), kStand);
  d.ms += 50;
  EXPECT_EQ(d.send_for(600, kForward), State::kHeld);
  EXPECT_EQ(d.send(kStand), State::kAlive);
}

}  // namespace
}  // namespace dynslam
