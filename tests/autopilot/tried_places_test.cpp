// SPDX-License-Identifier: MIT
#include "autopilot/tried_places.h"

#include <chrono>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

using std::chrono::seconds;

TEST(TriedPlaces, CountsTheTriesOfWhatIsNear) {
  TriedPlaces tried(0.5);
  EXPECT_EQ(tried.find({0, 0}), nullptr);
  EXPECT_EQ(tried.add(time_at_s(1), {0, 0}, seconds(10)), 1);
  EXPECT_EQ(tried.add(time_at_s(2), {0.3, 0.3}, seconds(10)), 2);
  EXPECT_EQ(tried.add(time_at_s(3), {0.5, 0}, seconds(10)), 1) << "half a metre is another place";
  ASSERT_NE(tried.find({-0.4, 0}), nullptr);
  EXPECT_EQ(tried.find({-0.4, 0})->tries, 2);
  EXPECT_EQ(tried.find({-0.4, 0})->until, time_at_s(12));
  EXPECT_EQ(tried.find({0.4, 0})->tries, 1) << "the nearest one";
}

TEST(TriedPlaces, ARestIsTheEndOfTheCount) {
  TriedPlaces tried(0.5);
  tried.add(time_at_s(1), {0, 0}, seconds(10));
  tried.rest(time_at_s(2), {0, 0}, seconds(100));
  EXPECT_EQ(tried.find({0, 0})->until, time_at_s(102));
  EXPECT_EQ(tried.add(time_at_s(200), {0, 0}, seconds(10)), 1);
}

TEST(TriedPlaces, ForgetsWhatWasTriedLongestAgo) {
  TriedPlaces tried(0.5, 3);
  for (int i = 0; i < 3; ++i) tried.add(time_at_s(i), {1.0 * i, 0}, seconds(1));
  tried.add(time_at_s(4), {0, 0}, seconds(1));
  tried.add(time_at_s(5), {9, 0}, seconds(1));
  EXPECT_EQ(tried.find({1, 0}), nullptr);
  for (const double x : {0.0, 2.0, 9.0}) EXPECT_NE(tried.find({x, 0}), nullptr) << x;
}

}  // namespace
}  // namespace dynslam
