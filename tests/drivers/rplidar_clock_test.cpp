// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "drivers/rplidar/arrival_clock.h"

namespace dynslam::rplidar {
namespace {

constexpr double kStep_s = 0.00604;

/// The largest error, in ms, from some time on, of packets that come at even steps, `faster` times as fast as
/// they say, and are read so late.
double worst_ms(double faster, double from_s, double to_s, const std::function<double(double)>& late_s) {
  ArrivalClock clock;
  double worst = 0.0;
  for (double came_s = 0.0; came_s < to_s; came_s += kStep_s / faster) {
    const Time came = time_at_s(100.0 + came_s), read = came + from_seconds(late_s(came_s));
    const Time told = clock.next(read, from_seconds(kStep_s));
    EXPECT_LE(told, read);
    if (came_s >= from_s) worst = std::max(worst, 1000.0 * std::abs(to_seconds(told - came)));
  }
  return worst;
}

/// Now and then at once, mostly some time later.
std::function<double(double)> busy(double mean_s, double at_once) {
  return [mean_s, at_once, random = std::mt19937(7)](double) mutable {
    std::uniform_real_distribution<double> luck(0.0, 1.0);
    return luck(random) < at_once ? 0.0001 * luck(random) : -mean_s * std::log(1.0 - luck(random));
  };
}

TEST(ArrivalClock, TellsWhenPacketsCameWhateverTheReadersDelays) {
  EXPECT_LT(worst_ms(1.0, 1.0, 20.0, busy(0.002, 0.2)), 0.5);
  EXPECT_LT(worst_ms(1.0, 2.0, 20.0, busy(0.02, 0.05)), 1.0);
}

TEST(ArrivalClock, LearnsHowMuchFasterOrSlowerTheLidarsClockGoes) {
  for (const double faster : {0.995, 0.9995, 1.0005, 1.005}) {
    EXPECT_LT(worst_ms(faster, 5.0, 40.0, busy(0.002, 0.2)), 0.7) << faster;
    EXPECT_LT(worst_ms(faster, 15.0, 40.0, busy(0.02, 0.05)), 1.5) << faster;
  }
}

TEST(ArrivalClock, IsNotTakenInByAReaderThatIsLateForSeconds) {
  const auto late = [](double came_s) { return came_s > 10.0 && came_s < 13.0 ? 0.03 : 0.0; };
  EXPECT_LT(worst_ms(1.0, 1.0, 20.0, late), 0.5);
  EXPECT_LT(worst_ms(0.999, 8.0, 20.0, late), 0.5);
}

TEST(ArrivalClock, FollowsAClockThatGetsWarm) {
  ArrivalClock clock;
  auto late_s = busy(0.002, 0.2);
  double came_s = 0.0, worst = 0.0;
  for (double faster = 1.0; faster < 1.002; faster += 1e-7, came_s += kStep_s / faster) {  // two minutes
    const Time came = time_at_s(came_s), read = came + from_seconds(late_s(came_s));
    const Time told = clock.next(read, from_seconds(kStep_s));
    if (came_s > 5.0) worst = std::max(worst, std::abs(to_seconds(told - came)));
  }
  EXPECT_LT(worst, 0.002);
}

TEST(ArrivalClock, BeginsAnewAfterABreakAndAfterLostPackets) {
  ArrivalClock clock;
  const Duration step = from_seconds(kStep_s);
  Time t = time_at_s(1.0);
  for (int i = 0; i < 1000; ++i) clock.next(t += step, step);
  EXPECT_EQ(clock.next(t += std::chrono::seconds(1), step), t);
  clock.next(t += step, step);
  clock.forget();
  t += std::chrono::milliseconds(40);
  EXPECT_EQ(clock.next(t, step), t);
}

TEST(ArrivalClock, TakesAPacketThatCameEarlierThanItCanAsTheBetterOne) {
  ArrivalClock clock;
  const Duration step = from_seconds(kStep_s), late = std::chrono::milliseconds(5);
  Time t = time_at_s(1.0);
  for (int i = 0; i < 10; ++i, t += step) clock.next(t + late, step);
  EXPECT_EQ(clock.next(t, step), t);
  t += step;
  EXPECT_NEAR(to_seconds(clock.next(t + late, step) - t), 0.0, 1e-6);
}

}  // namespace
}  // namespace dynslam::rplidar
