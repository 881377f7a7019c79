// SPDX-License-Identifier: MIT
#include <deque>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "pipe/bounded_queue.h"
#include "pipe/clock.h"
#include "pipe/latest.h"
#include "pipe/recent.h"

namespace dynslam {
namespace {

constexpr Clock::SteadyTime kLongAgo{};
Clock::SteadyTime in_a_minute() { return std::chrono::steady_clock::now() + std::chrono::minutes(1); }

TEST(Latest, HoldsTheNewestAndCounts) {
  Latest<int> pipe;
  EXPECT_EQ(pipe.get().value, nullptr);
  EXPECT_EQ(pipe.get().version, 0U);
  pipe.put(1);
  pipe.put(2);
  EXPECT_EQ(*pipe.get().value, 2);
  EXPECT_EQ(pipe.get().version, 2U);
}

TEST(Latest, AReaderKeepsWhatItHas) {
  Latest<int> pipe;
  pipe.put(1);
  const auto mine = pipe.get().value;
  pipe.put(2);
  EXPECT_EQ(*mine, 1);
}

TEST(Latest, WaitsNoLongerThanItIsTold) {
  Latest<int> pipe;
  EXPECT_EQ(pipe.wait(0, kLongAgo).version, 0U);
  pipe.put(7);
  EXPECT_EQ(*pipe.wait(0, in_a_minute()).value, 7) << "there is one already";
}

TEST(Latest, WakesWhoWaits) {
  Latest<int> pipe;
  std::jthread writer([&] { pipe.put(3); });
  EXPECT_EQ(*pipe.wait(0, in_a_minute()).value, 3);
}

TEST(Latest, CloseWakesWhoWaits) {
  Latest<int> pipe;
  std::jthread closer([&] { pipe.close(); });
  EXPECT_EQ(pipe.wait(0, in_a_minute()).version, 0U);
}

TEST(Latest, VersionsAreNeverSeenGoingBack) {
  Latest<std::uint64_t> pipe;
  std::jthread writer([&] {
    for (std::uint64_t i = 1; i <= 20000; ++i) pipe.put(i);
  });
  std::uint64_t seen = 0;
  while (seen < 20000) {
    const auto item = pipe.wait(seen, in_a_minute());
    ASSERT_GT(item.version, seen);
    ASSERT_EQ(*item.value, item.version);
    seen = item.version;
  }
}

TEST(Recent, KeepsTheLastOnesHoweverOftenTheyAreLookedAt) {
  Recent<int> recent(3);
  EXPECT_TRUE(recent.all().empty());
  for (int i = 1; i <= 5; ++i) recent.push(i);
  EXPECT_EQ(recent.all(), (std::vector<int>{3, 4, 5}));
  EXPECT_EQ(recent.all(), (std::vector<int>{3, 4, 5}));
}

TEST(BoundedQueue, DropsTheOldestAndCountsIt) {
  BoundedQueue<int> pipe(2);
  EXPECT_TRUE(pipe.push(1));
  EXPECT_TRUE(pipe.push(2));
  EXPECT_FALSE(pipe.push(3));
  EXPECT_EQ(pipe.dropped(), 1U);
  EXPECT_EQ(pipe.try_pop(), 2);
  EXPECT_EQ(pipe.pop(kLongAgo), 3);
  EXPECT_EQ(pipe.pop(kLongAgo), std::nullopt);
}

TEST(BoundedQueue, AgreesWithADequeOverRandomDeeds) {
  std::mt19937 random(1);
  BoundedQueue<int> pipe(5);
  std::deque<int> model;
  std::uint64_t dropped = 0;
  for (int i = 0; i < 10000; ++i) {
    if (random() % 2 == 0) {
      pipe.push(i);
      model.push_back(i);
      if (model.size() > 5) model.pop_front(), ++dropped;
    } else {
      const auto got = pipe.try_pop();
      ASSERT_EQ(got.has_value(), !model.empty());
      if (!got) continue;
      ASSERT_EQ(*got, model.front());
      model.pop_front();
    }
  }
  EXPECT_EQ(pipe.dropped(), dropped);
}

TEST(BoundedQueue, WhatGoesInComesOutOrIsCounted) {
  BoundedQueue<int> pipe(8);
  constexpr int kEach = 5000;
  std::uint64_t out = 0;
  {
    std::vector<std::jthread> writers;
    for (int w = 0; w < 3; ++w) {
      writers.emplace_back([&] {
        for (int i = 0; i < kEach; ++i) pipe.push(i);
      });
    }
    while (pipe.pop(std::chrono::steady_clock::now() + std::chrono::milliseconds(50))) ++out;
  }
  while (pipe.try_pop()) ++out;
  EXPECT_EQ(out + pipe.dropped(), 3U * kEach);
}

TEST(BoundedQueue, AfterCloseTheRestComesOutAndNothingGoesIn) {
  BoundedQueue<std::unique_ptr<int>> pipe(4);
  pipe.push(std::make_unique<int>(1));
  pipe.close();
  pipe.push(std::make_unique<int>(2));
  EXPECT_EQ(**pipe.pop(in_a_minute()), 1);
  EXPECT_EQ(pipe.pop(in_a_minute()), std::nullopt) << "nobody waits for what cannot come";
}

TEST(Clock, ASteppedOneStandsUntilItIsSet) {
  SteppedClock clock(time_at_s(5));
  EXPECT_EQ(clock.now(), time_at_s(5));
  clock.set(time_at_s(6));
  EXPECT_EQ(clock.now(), time_at_s(6));
  EXPECT_LT(clock.steady(time_at_s(100)), std::chrono::steady_clock::now()) << "nobody waits by it";
}

TEST(Clock, ARunningOneAgreesWithWhatThreadsWaitBy) {
  const RunningClock clock(time_at_s(100), 10.0);
  const auto real = clock.steady(time_at_s(110)) - clock.steady(time_at_s(100));
  EXPECT_NEAR(std::chrono::duration<double>(real).count(), 1.0, 1e-6);
  const Time a = clock.now(), b = clock.now();
  EXPECT_GE(a, time_at_s(100));
  EXPECT_GE(b, a);
}

}  // namespace
}  // namespace dynslam
