// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/control_channel.h"
#include "server/wire_bytes.h"

namespace dynslam {
namespace {

using nlohmann::json;

Channel::SteadyTime at(double s) {
  return Channel::SteadyTime(
      std::chrono::duration_cast<Channel::SteadyTime::duration>(std::chrono::duration<double>(s)));
}
WsMessage text(const std::string& payload) { return {WsOpcode::kText, payload}; }

class ControlTest : public testing::Test {
 protected:
  std::unique_ptr<ControlChannel> enter(const std::string& name, bool may_drive = true) {
    return std::make_unique<ControlChannel>(wheel, ports, clock, events, ControlClient{name, may_drive},
                                            StillAllowed());
  }
  /// All that the client is told now.
  std::vector<json> told(ControlChannel& channel, double s = 0.0) {
    std::vector<json> all;
    while (const auto message = channel.next(at(s))) all.push_back(json::parse(message->payload));
    return all;
  }
  void say(ControlChannel& channel, const std::string& message, double s = 0.0) {
    EXPECT_FALSE(channel.take(text(message), at(s)));
  }
  DriveCommand commanded() { return *ports.command.get().value; }
  /// The motors answer the newest command after a while.
  void answer(Duration after) {
    DriveState state;
    state.answered = commanded();
    state.driven = state.answered->heard + after;
    state.verdict = {Motion::kSlow, "a wall"};
    ports.drive.put(state);
  }

  Ports ports;
  SteppedClock clock{time_at_s(10)};
  EventCounters events;
  Wheel wheel{ports, clock, {1.0, 2.0}};
};

TEST_F(ControlTest, OnlyWhoHoldsTheWheelCommands) {
  const auto a = enter("Ada"), b = enter("Bob");
  EXPECT_EQ(told(*a)[0]["wheel"], (json{{"mine", false}, {"driver", nullptr}}));
  say(*a, R"({"seq":1,"v":0.5,"w":0})");
  EXPECT_FALSE(ports.command.get().value);
  say(*a, R"({"lease":"acquire"})");
  EXPECT_EQ(told(*a)[0]["wheel"], (json{{"mine", true}, {"driver", "Ada"}}));
  say(*b, R"({"lease":"acquire"})");
  const auto b_told = told(*b);
  EXPECT_NE(b_told[0]["error"], nullptr);
  EXPECT_EQ(b_told[1]["wheel"], (json{{"mine", false}, {"driver", "Ada"}}));
  say(*a, R"({"seq":2,"v":0.5,"w":-0.25})");
  EXPECT_EQ(commanded().twist, (Twist{0.5, -0.25}));
  EXPECT_EQ(commanded().heard, time_at_s(10));

  say(*b, R"({"lease":"take_over"})");
  EXPECT_TRUE(commanded().gone) << "the robot stops between two drivers";
  EXPECT_EQ(told(*b)[0]["wheel"], (json{{"mine", true}, {"driver", "Bob"}}));
  EXPECT_EQ(told(*a, 0.2).back()["wheel"], (json{{"mine", false}, {"driver", "Bob"}}));
}

TEST_F(ControlTest, SpeedsAreClampedToWhatTheRobotCanDo) {
  const auto a = enter("Ada");
  say(*a, R"({"lease":"acquire"})");
  say(*a, R"({"seq":1,"v":1e300,"w":-7})");
  EXPECT_EQ(commanded().twist, (Twist{1.0, -2.0}));
}

TEST_F(ControlTest, TheRobotStopsAtOnceWhenTheDriverIsGone) {
  auto a = enter("Ada");
  say(*a, R"({"lease":"acquire"})");
  say(*a, R"({"seq":1,"v":1,"w":0})");
  const auto before = commanded().seq;
  clock.set(time_at_s(10.03));
  a.reset();
  EXPECT_TRUE(commanded().gone);
  EXPECT_EQ(commanded().twist, Twist());
  EXPECT_GT(commanded().seq, before);
  EXPECT_EQ(commanded().heard, time_at_s(10.03));
  EXPECT_FALSE(wheel.holder(0).driver);
  answer(std::chrono::milliseconds(12));
  EXPECT_EQ(wheel.delays().drop_to_off.count(), 1U);
  EXPECT_NEAR(wheel.delays().drop_to_off.sum_s(), 0.012, 1e-9);
}

TEST_F(ControlTest, WhoLooksOnChangesNothingByLeaving) {
  auto a = enter("Ada"), b = enter("Bob");
  say(*a, R"({"lease":"acquire"})");
  say(*a, R"({"seq":1,"v":1,"w":0})");
  b.reset();
  EXPECT_FALSE(commanded().gone);
  EXPECT_TRUE(wheel.holder(0).driver);
}

TEST_F(ControlTest, EachCommandIsAnsweredWithTheDelayThatWasMeasured) {
  const auto a = enter("Ada");
  say(*a, R"({"lease":"acquire"})");
  say(*a, R"({"seq":70,"v":0,"w":0})");
  told(*a);
  answer(std::chrono::milliseconds(14));
  say(*a, R"({"seq":72,"v":0,"w":0})");
  const auto ack = told(*a)[0];
  EXPECT_EQ(ack["ack"], 72);
  EXPECT_EQ(ack["driven"], (json{{"seq", 70}, {"ms", 14.0}}));
  EXPECT_EQ(ack["motion"], "slow");
  EXPECT_EQ(ack["reason"], "a wall");
  say(*a, R"({"seq":73,"v":0,"w":0})");
  EXPECT_EQ(told(*a)[0]["driven"], nullptr) << "70 was told of";
  EXPECT_EQ(wheel.delays().command_to_motor.count(), 1U);
}

TEST_F(ControlTest, WhatComesOutOfOrderIsDropped) {
  const auto a = enter("Ada");
  say(*a, R"({"lease":"acquire"})");
  say(*a, R"({"seq":5,"v":0.1,"w":0})");
  say(*a, R"({"seq":4,"v":0.4,"w":0})");
  say(*a, R"({"seq":5,"v":0.5,"w":0})");
  EXPECT_EQ(commanded().twist.v_mps, 0.1);
  EXPECT_EQ(events.get()["server.control_out_of_order"], 2U);
}

TEST_F(ControlTest, WhatIsNotUnderstoodIsRefusedAndCounted) {
  const auto a = enter("Ada");
  told(*a);
  say(*a, R"({"seq":5,"v":NaN,"w":0})");
  say(*a, "?");
  const auto answers = told(*a);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[1]["errors"], 2);
  EXPECT_EQ(events.get()["server.control_messages_refused"], 2U);
  EXPECT_TRUE(a->take({WsOpcode::kBinary, "x"}, at(0)));
}

TEST_F(ControlTest, AFloodIsDroppedAndThenCut) {
  const auto a = enter("Ada");
  int taken = 0;
  std::optional<WsClosing> closed;
  while (!closed && ++taken < 10000) closed = a->take(text(R"({"stop":true})"), at(1.0));
  ASSERT_TRUE(closed);
  EXPECT_EQ(closed->code, 1008);
  EXPECT_EQ(taken, 60 + 500 + 1);
  EXPECT_LE(told(*a).size(), 65U) << "and what is said back is bounded";
}

TEST_F(ControlTest, AnybodyHereMayStopButAViewerMayNotDrive) {
  const auto viewer = enter("Eve", false);
  told(*viewer);
  say(*viewer, R"({"stop":true})");
  EXPECT_EQ(told(*viewer)[0]["stopped"], true);
  EXPECT_EQ(ports.stops.try_pop(), "Eve");
  say(*viewer, R"({"lease":"take_over"})");
  EXPECT_EQ(told(*viewer)[0]["error"], "only a driver may take the wheel");
  EXPECT_FALSE(wheel.holder(0).driver);
}

TEST_F(ControlTest, AForgottenWheelIsFreeForAll) {
  const auto a = enter("Ada"), b = enter("Bob");
  say(*a, R"({"lease":"acquire"})", 0.0);
  say(*a, R"({"seq":1,"v":0,"w":0})", 5.0);
  say(*b, R"({"lease":"acquire"})", 14.9);
  EXPECT_EQ(wheel.holder(0).driver, "Ada");
  say(*b, R"({"lease":"acquire"})", 15.1);
  EXPECT_EQ(wheel.holder(0).driver, "Bob");
  say(*b, R"({"lease":"release"})", 15.2);
  EXPECT_FALSE(wheel.holder(0).driver);
}

TEST_F(ControlTest, TakesAStopHoweverMuchElseIsSaid) {
  const auto a = enter("Ada");
  for (int n = 0; n < 200; ++n) say(*a, "{\"seq\":" + std::to_string(n) + ",\"v\":1,\"w\":0}");
  EXPECT_FALSE(ports.stops.try_pop());
  say(*a, R"({"stop":true})");
  EXPECT_EQ(ports.stops.try_pop(), "Ada");
}

TEST_F(ControlTest, WhoTakesOverBeginsAnewHoweverSoonHeCommands) {
  const auto a = enter("Ada"), b = enter("Bob");
  say(*a, R"({"lease":"acquire"})");
  say(*a, R"({"seq":1,"v":0.5,"w":0})");
  EXPECT_FALSE(ports.driver_left);
  say(*b, R"({"lease":"take_over"})");
  say(*b, R"({"seq":1,"v":0.5,"w":0})");
  EXPECT_TRUE(ports.driver_left) << "though his command came before the robot looked";
}

TEST(Wheel, LetsARobotDriveItselfUntilSomebodySteers) {
  Ports ports;
  SteppedClock clock{time_at_s(10)};
  Wheel wheel(ports, clock, {1.0, 2.0}, [] { return true; });
  const auto ada = wheel.enter();
  ASSERT_TRUE(wheel.acquire(ada, "Ada", false, at(1)));
  EXPECT_TRUE(wheel.drive(ada, {})) << "she holds the wheel";
  EXPECT_FALSE(ports.command.get().value) << "but the robot need not know";
  wheel.release(ada);
  EXPECT_FALSE(ports.command.get().value);

  ASSERT_TRUE(wheel.acquire(ada, "Ada", false, at(2)));
  EXPECT_FALSE(wheel.is_steered());
  wheel.drive(ada, {0.5, 0.0});
  EXPECT_TRUE(wheel.is_steered());
  EXPECT_EQ(ports.command.get().value->twist.v_mps, 0.5);
  wheel.drive(ada, {});
  EXPECT_EQ(ports.command.get().value->twist.v_mps, 0.0) << "who has steered is obeyed to the end";
  EXPECT_TRUE(wheel.is_steered());

  const auto bob = wheel.enter();
  ASSERT_TRUE(wheel.acquire(bob, "Bob", true, at(3)));
  EXPECT_TRUE(ports.command.get().value->gone);
  EXPECT_FALSE(wheel.is_steered()) << "he has not steered yet";
  wheel.leave(bob);
  EXPECT_FALSE(wheel.is_steered());
}

TEST(Wheel, AnOrderMakesAnOnlookerOfWhoeverSteered) {
  Ports ports;
  SteppedClock clock{time_at_s(10)};
  Wheel wheel(ports, clock, {1.0, 2.0});
  const auto ada = wheel.enter();
  ASSERT_TRUE(wheel.acquire(ada, "Ada", false, at(1), "ada's phone"));
  wheel.drive(ada, {0.5, 0.0});
  wheel.drive(ada, {});
  EXPECT_EQ(wheel.order(Explore{}, "bob's phone", at(2)), "Ada") << "she steers";
  EXPECT_FALSE(ports.orders.try_pop());
  EXPECT_FALSE(wheel.order(Explore{}, "ada's phone", at(2)));
  EXPECT_TRUE(ports.orders.try_pop());
  EXPECT_FALSE(wheel.is_steered());

  AutopilotStatus status;
  status.phase = AutopilotPhase::kActive;
  ports.autopilot.put(status);
  const auto before = ports.command.get().version;
  EXPECT_EQ(wheel.drive(ada, {})->seq, 0U);
  EXPECT_EQ(ports.command.get().version, before) << "her zeros do not compete";
  wheel.drive(ada, {0.0, 0.3});
  EXPECT_EQ(ports.command.get().value->twist.w_radps, 0.3) << "until she pushes again";
  wheel.drive(ada, {});
  EXPECT_EQ(ports.command.get().value->twist.w_radps, 0.0);
  EXPECT_TRUE(wheel.is_steered());

  status.phase = AutopilotPhase::kIdle;
  ports.autopilot.put(status);
  EXPECT_FALSE(wheel.order(StandBy{}, "ada's phone", at(3)));
  const auto idle = ports.command.get().version;
  wheel.drive(ada, {});
  EXPECT_GT(ports.command.get().version, idle) << "a robot that has nothing to do hears its driver";
  wheel.drive(ada, {0.5, 0.0});
  EXPECT_TRUE(wheel.order(StandBy{}, "bob's phone", at(10)));
  EXPECT_FALSE(wheel.order(StandBy{}, "bob's phone", at(12))) << "nothing was heard of her for too long";
}

TEST_F(ControlTest, CountsOnFromWhoCommandedBefore) {
  ports.command.put({500, {}, time_at_s(9), false});
  const auto a = enter("Ada");
  say(*a, R"({"lease":"acquire"})");
  say(*a, R"({"seq":1,"v":0,"w":0})");
  EXPECT_EQ(commanded().seq, 501U);
}

TEST(StateChannel, TellsNineTimesASecondAndOnceForAll) {
  Ports ports;
  int made = 0;
  StateFeed feed(ports, [&made] { return std::to_string(++made); });
  StateChannel a(feed, {}), b(feed, {});
  int told = 0;
  for (int ms = 0; ms < 990; ms += 5) {
    told += a.next(at(1.0 + 0.001 * ms)) ? 1 : 0;
    b.next(at(1.0 + 0.001 * ms));
  }
  EXPECT_EQ(told, 9);
  EXPECT_EQ(made, 9);
  EXPECT_GT(a.due(), at(1.985));
  EXPECT_TRUE(a.take(text("x"), at(3)));
}

TEST(StateChannel, DoesNotKeepAScanWaiting) {
  Ports ports;
  StateFeed feed(ports, [&ports] { return std::to_string(ports.scan.get().version); });
  StateChannel channel(feed, {});
  ASSERT_TRUE(channel.next(at(1)));
  for (int n = 1; n <= 10; ++n) {
    ports.scan.put(Scan());
    const double t = 1 + 0.1 * n + (n % 2 ? 0.004 : -0.004);  // a lidar's pace is not quite steady
    const auto told = channel.next(at(t));
    ASSERT_TRUE(told) << n;
    EXPECT_EQ(told->payload, std::to_string(n));
    EXPECT_FALSE(channel.next(at(t + 0.09)));
  }
}

TEST(StateChannel, KeepsItsPaceHoweverFastScansCome) {
  Ports ports;
  StateFeed feed(ports, [] { return std::string("{}"); });
  StateChannel channel(feed, {});
  int told = 0;
  for (int ms = 0; ms < 1000; ms += 5) {
    ports.scan.put(Scan());
    told += channel.next(at(1.0 + 0.001 * ms)) ? 1 : 0;
  }
  EXPECT_EQ(told, 20);
}

TEST(WatchChannel, EndsWhenItsClientMayNotBeThereAnyMore) {
  Ports ports;
  StateFeed feed(ports, [] { return std::string(); });
  std::string why;
  StateChannel channel(feed, [&why] { return why; });
  EXPECT_FALSE(channel.ended(at(1)));
  why = "logged out";
  EXPECT_FALSE(channel.ended(at(1.5))) << "asked once a second";
  ASSERT_TRUE(channel.ended(at(2.1)));
  EXPECT_EQ(channel.ended(at(3.2))->code, 1008);
}

TEST(MapChannel, WaitsForWhatTheClientHas) {
  Ports ports;
  SteppedClock clock;
  ChunkedGrid grid(0.05);
  for (int i = 0; i < 3; ++i) grid.add_hit({1, 1});
  WorldState world;
  world.map = grid.snapshot();
  ports.world.put(world);
  MapFeed feed(ports, clock, 9);
  const auto have = [](std::uint64_t map_id, std::uint32_t version) {
    std::string bytes;
    append_le(bytes, std::uint32_t{1});
    append_le(bytes, std::uint32_t{1});
    append_le(bytes, map_id);
    append_le(bytes, std::uint32_t{0});
    append_le(bytes, version);
    return WsMessage{WsOpcode::kBinary, bytes};
  };
  MapChannel silent(feed, {}), returning(feed, {}), stranger(feed, {}), babbling(feed, {});
  EXPECT_FALSE(silent.next(at(1)));
  EXPECT_FALSE(returning.take(have(9, 1), at(1)));
  EXPECT_FALSE(stranger.take(have(8, 1), at(1)));
  EXPECT_EQ(read_le<std::uint16_t>(returning.next(at(1.2))->payload, 2), 0) << "it has all";
  EXPECT_EQ(read_le<std::uint16_t>(stranger.next(at(1.2))->payload, 2), 1) << "of another map";
  EXPECT_FALSE(returning.next(at(1.4)));
  EXPECT_TRUE(returning.take(have(9, 1), at(1.5))) << "twice";
  EXPECT_TRUE(babbling.take(text("map please"), at(1)));
}

TEST(VideoChannel, SendsTheNewestWhenTheClientKeepsUp) {
  Ports ports;
  ports.video.put({time_at_s(1), {1}});
  std::optional<VideoChannel> channel;
  channel.emplace(ports, StillAllowed());
  EXPECT_EQ(ports.watchers, 1);
  double s = 1.0;
  const auto picture = [&] { return channel->next(at(s += 0.01)); };
  EXPECT_FALSE(picture()) << "that one was taken for somebody else";
  for (std::uint8_t i = 2; i <= 9; ++i) {
    ports.video.put({time_at_s(i), {i}});
    const auto sent = picture();
    EXPECT_EQ(sent.has_value(), i <= 3) << int{i};
    if (sent) {
      EXPECT_EQ(sent->payload.back(), static_cast<char>(i));
    }
  }
  EXPECT_FALSE(channel->take(text(R"({"ack":1})"), at(s)));
  const auto newest = picture();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->payload.back(), 9) << "those between are left out";
  EXPECT_EQ(read_le<std::uint32_t>(newest->payload, 4), 3U);
  EXPECT_TRUE(channel->take(text(R"({"ack":4})"), at(s))) << "was never sent";
  EXPECT_TRUE(channel->take(text("ok"), at(s)));
  EXPECT_FALSE(channel->ended(at(s + 9)));
  EXPECT_TRUE(channel->ended(at(s + 11))) << "a client that shows nothing";
  channel.reset();
  EXPECT_EQ(ports.watchers, 0);
}

}  // namespace
}  // namespace dynslam
