// SPDX-License-Identifier: MIT
#include "work_meter.h"

#include <gtest/gtest.h>

#include "robot/robot.h"

namespace dynslam {
namespace {

const WorkCost& cost_of(const WorkMeter& meter, Work work) {
  return meter.costs()[static_cast<std::size_t>(work)];
}

/// Some tenths of a millisecond of work.
void work() {
  volatile unsigned sum = 0;
  for (unsigned i = 0; i < 300'000; ++i) sum = sum + i;
}

/// One step of a robot that has a scan or has none.
void step(WorkMeter& meter, bool has_scan) {
  meter.enter(Robot::kSensing);
  meter.enter(Robot::kMapping);
  work();
  if (has_scan) {
    for (const char* stage : {"passes", "match", "insert", "draw", ""}) meter.enter(stage);
  }
  meter.enter(Robot::kControlling);
  meter.rest();
}

TEST(WorkMeter, CountsMappingByScansAndOtherWorkByTurns) {
  WorkMeter meter;
  for (int i = 0; i < 6; ++i) step(meter, i % 3 == 2);
  EXPECT_EQ(cost_of(meter, Work::kMapping).ms.size(), 2U);
  EXPECT_EQ(cost_of(meter, Work::kSensing).ms.size(), 2U);
  EXPECT_EQ(cost_of(meter, Work::kControlling).ms.size(), 6U);
  EXPECT_EQ(cost_of(meter, Work::kPlanning).ms.size(), 0U);
}

TEST(WorkMeter, WaitingForAScanIsPartOfItsCost) {
  WorkMeter meter;
  step(meter, true);
  for (int i = 0; i < 20; ++i) step(meter, i == 19);
  const auto& ms = cost_of(meter, Work::kMapping).ms;
  ASSERT_EQ(ms.size(), 2U);
  EXPECT_GT(ms[1], 3 * ms[0]);
}

TEST(WorkMeter, SeesLoopsAndPlansApart) {
  WorkMeter meter;
  meter.enter("match");
  meter.enter("close loops");
  work();
  meter.enter("draw");
  meter.enter("");
  meter.enter(Robot::kPlanning);
  meter.rest();
  EXPECT_EQ(cost_of(meter, Work::kLoops).ms.size(), 1U);
  EXPECT_GT(cost_of(meter, Work::kLoops).total_ms(), 3 * cost_of(meter, Work::kMapping).total_ms());
  EXPECT_EQ(cost_of(meter, Work::kPlanning).ms.size(), 1U);
}

TEST(WorkMeter, RestIsNobodysWork) {
  WorkMeter meter;
  meter.begin(Work::kServing);
  meter.count(Work::kServing);
  meter.rest();
  work();
  meter.begin(Work::kServing);
  meter.count(Work::kServing);
  meter.rest();
  EXPECT_EQ(cost_of(meter, Work::kServing).ms.size(), 2U);
  EXPECT_LT(cost_of(meter, Work::kServing).total_ms(), 0.2);
}

}  // namespace
}  // namespace dynslam
