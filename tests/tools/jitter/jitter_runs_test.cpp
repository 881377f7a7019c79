// SPDX-License-Identifier: MIT
#include "tools/jitter/jitter_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "slam/drawn_world.h"
#include "tools/jitter/made_recording.h"
#include "tools/jitter/spread.h"

namespace dynslam::jitter {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Pose2 world_T_robot(Time t) {
  const double s = seconds_of(t);
  return {2.0 + 0.2 * s, 2.4, 0.1 * s};
}

/// A robot that drives one metre through the two rooms in 5 s.
std::vector<Record> short_drive() {
  std::mt19937 random{5};
  std::vector<Record> records;
  for (int i = 0; i < 50; ++i) {
    const Time t = time_at_s(0.1 * i);
    records.emplace_back(OdometrySample{t, world_T_robot(t)});
    records.emplace_back(look(two_rooms(), t, world_T_robot, {.turn_s = 0.0, .noise_m = 0.01}, random));
  }
  return records;
}

std::vector<StampedPose> truth() {
  std::vector<StampedPose> way;
  for (int i = 0; i < 50; ++i) way.push_back({time_at_s(0.1 * i), world_T_robot(time_at_s(0.1 * i))});
  return way;
}

std::unique_ptr<Recording> open_drive() { return std::make_unique<MadeRecording>(short_drive()); }

std::vector<CopyResult> run(int jobs, std::vector<CopyResult>& told) {
  const JitterPlan plan{.jitter = {}, .slam = {}, .copies = 4, .seed = 11, .jobs = jobs};
  return run_copies(open_drive, truth(), plan, [&](const CopyResult& copy) { told.push_back(copy); });
}

TEST(RunCopies, GivesTheRecordingAndThenItsCopies) {
  std::vector<CopyResult> told;
  const std::vector<CopyResult> results = run(1, told);
  ASSERT_EQ(results.size(), 5U);
  EXPECT_EQ(results[0].seed, std::nullopt);
  EXPECT_EQ(results[0].scans, 50U);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_EQ(results[i].seed, 10 + i);
    EXPECT_LE(results[i].scans, 20U);
    EXPECT_LT(results[i].final_m, 0.03);
    EXPECT_EQ(results[i].final_m, results[i].live_m) << "no loop was closed";
  }
}

TEST(RunCopies, GivesTheSameInManyThreads) {
  std::vector<CopyResult> told_by_one, told_by_three;
  const std::vector<CopyResult> one = run(1, told_by_one), three = run(3, told_by_three);
  ASSERT_EQ(told_by_three.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(three[i].seed, one[i].seed);
    EXPECT_EQ(three[i].final_m, one[i].final_m);
    EXPECT_EQ(told_by_three[i].final_m, one[i].final_m);
  }
}

TEST(RunCopies, RefusesWhatCannotBeJudged) {
  const auto complaint_of = [](std::vector<Record> records, std::optional<std::string> damage) {
    return [=] {
      const auto open = [&] { return std::make_unique<MadeRecording>(records, damage); };
      run_copies(open, truth(), {.jitter = {}, .slam = {}, .copies = 3, .jobs = 2}, [](const CopyResult&) {});
    };
  };
  EXPECT_THAT(complaint_of(short_drive(), "made: broken off"),
              ThrowsMessage<InputError>(HasSubstr("made: broken off")));
  EXPECT_THAT(complaint_of({}, {}), ThrowsMessage<InputError>(HasSubstr("no usable scan")));
}

TEST(Spread, HasTheMiddleOfAnEvenCount) {
  const Spread odd = spread_of({3, 1, 8}), even = spread_of({4, 1, 10, 2});
  EXPECT_EQ(odd.median, 3);
  EXPECT_EQ(odd.mean, 4);
  EXPECT_EQ(even.min, 1);
  EXPECT_EQ(even.median, 3);
  EXPECT_EQ(even.max, 10);
}

TEST(Spread, IsNarrowByFactorOrByMargin) {
  const Tolerance tolerance{1.5, 0.05};
  EXPECT_TRUE(is_narrow({0, 1.0, 0, 1.5}, tolerance));
  EXPECT_FALSE(is_narrow({0, 1.0, 0, 1.51}, tolerance));
  EXPECT_TRUE(is_narrow({0, 0.01, 0, 0.06}, tolerance)) << "six times the median, but five centimetres";
  EXPECT_FALSE(is_narrow({0, 0.01, 0, 0.07}, tolerance));
}

}  // namespace
}  // namespace dynslam::jitter
