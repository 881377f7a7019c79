// SPDX-License-Identifier: MIT
#include "bench_report.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dynslam {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<float> from_one_to(int n) {
  std::vector<float> ms;
  for (int i = n; i >= 1; --i) ms.push_back(static_cast<float>(i));
  return ms;
}

/// Ten seconds with a hundred scans of 2 ms, and each other work once in a second for 10 ms.
BenchFigures figures() {
  BenchFigures f;
  f.version = "1.2.3";
  f.world = "apartment";
  f.machine.model = "Raspberry Pi 4 Model B Rev 1.4";
  f.machine.architecture = "aarch64";
  f.machine.cores = 4;
  f.drive_s = 10.0;
  f.scans = 100;
  for (WorkCost& cost : f.costs) cost.ms.assign(10, 10.0F);
  f.cost(Work::kMapping).ms.assign(100, 2.0F);
  f.peak_rss_bytes = 40L << 20;
  return f;
}

TEST(WorkCost, OneOfAHundredMayTakeLonger) {
  EXPECT_EQ(WorkCost{}.p99_ms(), 0.0);
  EXPECT_EQ(WorkCost{}.mean_ms(), 0.0);
  EXPECT_EQ(WorkCost{from_one_to(1)}.p99_ms(), 1.0);
  EXPECT_EQ(WorkCost{from_one_to(99)}.p99_ms(), 99.0);
  EXPECT_EQ(WorkCost{from_one_to(100)}.p99_ms(), 99.0);
  EXPECT_EQ(WorkCost{from_one_to(1000)}.p99_ms(), 990.0);
  EXPECT_EQ(WorkCost{from_one_to(3)}.mean_ms(), 2.0);
  EXPECT_EQ(WorkCost{from_one_to(3)}.total_ms(), 6.0);
}

TEST(BenchReport, WorkOfScansGoesByTheLidarOtherWorkByTheClock) {
  const BenchFigures f = figures();
  EXPECT_NEAR(share_of_core(f, Work::kMapping), 0.002 * 12.5, 1e-9);
  EXPECT_NEAR(share_of_core(f, Work::kLoops), 0.1 / 100 * 12.5, 1e-9);
  EXPECT_NEAR(share_of_core(f, Work::kControlling), 0.01, 1e-9);
  EXPECT_NEAR(share_of_core(f, Work::kPicturing), 0.01 * 20, 1e-9);
}

TEST(BenchReport, PicturesAreOnTopOfTheSum) {
  BenchFigures f = figures();
  const double before = share_of_core(f);
  f.cost(Work::kPicturing).ms.assign(10, 99.0F);
  EXPECT_EQ(share_of_core(f), before);
  f.cost(Work::kServing).ms.assign(10, 99.0F);
  EXPECT_GT(share_of_core(f), before);
}

TEST(BenchReport, NothingDrivenCostsNothing) {
  const BenchFigures nothing;
  EXPECT_EQ(share_of_core(nothing), 0.0);
  EXPECT_THAT(bench_line(nothing), Not(HasSubstr("nan")));
  EXPECT_THAT(bench_table(nothing), Not(HasSubstr("nan")));
}

TEST(BenchReport, IsOneLineOfKeysAndValues) {
  BenchFigures f = figures();
  f.machine.governor = "ondemand";
  f.machine.temperature_c = 51.6;
  f.machine.throttled = 0x50000U;
  const std::string line = bench_line(f);
  EXPECT_THAT(line, StartsWith("dynslam-bench: version=1.2.3 model=\"Raspberry Pi 4 Model B Rev 1.4\" "));
  EXPECT_THAT(line, HasSubstr(" arch=aarch64 cores=4 "));
  EXPECT_THAT(line, HasSubstr(" governor=ondemand temp_c=52 throttled=0x50000 "));
  EXPECT_THAT(line, HasSubstr(" drive_s=10 scans=100 "));
  EXPECT_THAT(line, HasSubstr(" map_ms=2.000/2.000 "));
  EXPECT_THAT(line, HasSubstr(" rss_mib=40"));
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 0);
}

TEST(BenchReport, StaysOneLineWhateverTheMachineIsCalled) {
  BenchFigures f = figures();
  f.machine.model = "a \"board\"\nof mine\x1b";
  const std::string line = bench_line(f);
  EXPECT_THAT(line, HasSubstr(" model=\"a  board  of mine \" arch="));
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 0);
}

TEST(BenchReport, SaysWhatSlowsTheMachineDown) {
  BenchFigures f = figures();
  f.machine.advice = {"computer: it is slowed down"};
  EXPECT_THAT(bench_table(f), HasSubstr("computer: it is slowed down\n"));
  EXPECT_THAT(bench_table(f), HasSubstr("Raspberry Pi 4"));
}

}  // namespace
}  // namespace dynslam
