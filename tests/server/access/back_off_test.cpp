// SPDX-License-Identifier: MIT
#include "server/access/back_off.h"

#include <string>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

IpAddress ip(const std::string& text) { return parse_ip(text).value(); }

class BackOffTest : public testing::Test {
 protected:
  int wait(const std::string& address) { return static_cast<int>(back_off_.wait(ip(address), now_).count()); }
  void fail(const std::string& address) { back_off_.failed(ip(address), now_); }
  /// An address of its own for each number.
  static std::string address(int i) {
    return "10." + std::to_string(i >> 16) + '.' + std::to_string(i >> 8 & 255) + '.' +
           std::to_string(i & 255);
  }
  /// As many wrong guesses from as many addresses, as fast as they may.
  void guess_from(int first, int count) {
    for (int i = first; i < first + count; ++i)
      if (wait(address(i)) == 0) fail(address(i));
  }

  BackOff back_off_;
  BackOff::SteadyTime now_{seconds(1000)};
};

TEST_F(BackOffTest, DoublesUpToACap) {
  EXPECT_EQ(wait("10.0.0.1"), 0);
  for (const int expected : {1, 2, 4, 8, 16, 32, 64, 128, 256, 300, 300, 300}) {
    fail("10.0.0.1");
    EXPECT_EQ(wait("10.0.0.1"), expected);
    now_ += seconds(expected) - milliseconds(1);
    EXPECT_EQ(wait("10.0.0.1"), 1) << "rounded up";
    now_ += milliseconds(1);
    EXPECT_EQ(wait("10.0.0.1"), 0) << "exactly then";
  }
}

TEST_F(BackOffTest, DoublesForEverWithoutHarm) {
  for (int i = 0; i < 100; ++i) fail("10.0.0.1");
  EXPECT_EQ(wait("10.0.0.1"), 300);
}

TEST_F(BackOffTest, ConcernsOneAddress) {
  for (int i = 0; i < 9; ++i) fail("10.0.0.1");
  EXPECT_EQ(wait("10.0.0.2"), 0);
  EXPECT_EQ(wait("fd00::1"), 0);
}

TEST_F(BackOffTest, TakesASubnetOfIpv6ForOne) {
  fail("fd00::1");
  EXPECT_EQ(wait("fd00::2"), 1);
  EXPECT_EQ(wait("fd00:0:0:1::1"), 0);
}

TEST_F(BackOffTest, NeverHoldsLoopbackForLong) {
  for (const char* loopback : {"127.0.0.1", "::1"}) {
    for (int i = 0; i < 40; ++i) fail(loopback);
    EXPECT_EQ(wait(loopback), 1) << loopback;
  }
}

TEST_F(BackOffTest, ForgivesAfterSuccessAndAfterAnHour) {
  for (int i = 0; i < 5; ++i) fail("10.0.0.1");
  back_off_.succeeded(ip("10.0.0.1"));
  back_off_.succeeded(ip("10.0.0.9"));  // never heard of
  EXPECT_EQ(wait("10.0.0.1"), 0);
  for (int i = 0; i < 5; ++i) fail("10.0.0.1");
  now_ += seconds(3600) - milliseconds(1);
  wait("10.0.0.1");
  fail("10.0.0.1");
  EXPECT_EQ(wait("10.0.0.1"), 32) << "not yet an hour";
  now_ += seconds(3600);
  fail("10.0.0.1");
  EXPECT_EQ(wait("10.0.0.1"), 1);
}

TEST_F(BackOffTest, SlowsNewcomersWhenManyGuess) {
  guess_from(0, 31);
  EXPECT_EQ(wait("10.9.0.1"), 1) << "one guess above the calm";
  guess_from(100, 1);
  now_ += seconds(1);
  EXPECT_EQ(wait("10.9.0.1"), 0) << "its turn was kept";
  now_ += seconds(60);
  EXPECT_EQ(wait("10.9.0.2"), 0) << "calm again";
}

TEST_F(BackOffTest, LetsTheRightfulInWhileMachinesGuess) {
  // 500 addresses guess whenever they may; somebody comes who has never been here.
  int looked_at = 0;
  std::optional<int> rightful_waits;
  for (int second = 0; second < 600; ++second, now_ += seconds(1)) {
    for (int i = 0; i < 500; ++i) {
      if (wait(address(i)) > 0) continue;
      fail(address(i));
      ++looked_at;
    }
    if (second == 300) rightful_waits = wait("192.168.1.5");
    if (rightful_waits && second == 300 + *rightful_waits) {
      EXPECT_EQ(wait("192.168.1.5"), 0);
    }
    EXPECT_EQ(wait("127.0.0.1"), 0);
  }
  ASSERT_TRUE(rightful_waits);
  EXPECT_LE(*rightful_waits, 10);
  // 1, 2, 4 ... 256 s: ten guesses each in ten minutes.
  EXPECT_LE(looked_at, 500 * 11);
}

TEST_F(BackOffTest, BoundsTheGuessesOfEverSoManyAddresses) {
  // Each guess comes from a new address: after the calm ones each has to come back, and only so many are
  // kept.
  int looked_at = 0;
  for (int i = 0; i < 20000; ++i) {
    if (wait(address(i)) > 0) continue;
    fail(address(i));
    ++looked_at;
  }
  EXPECT_EQ(looked_at, 31);
  EXPECT_EQ(back_off_.size(), BackOff::kMost);
}

TEST_F(BackOffTest, ForgetsWhoWasHeardOfLeastRecently) {
  fail("10.200.0.1");
  fail("10.200.0.2");
  for (int i = 0; i < 1022; ++i) wait(address(i));
  EXPECT_EQ(wait("10.200.0.1"), 1) << "still there, and now the newest";
  wait(address(2000));
  EXPECT_EQ(wait("10.200.0.1"), 1);
  EXPECT_EQ(wait("10.200.0.2"), 0);
  EXPECT_EQ(back_off_.size(), BackOff::kMost);
}

}  // namespace
}  // namespace dynslam
