// SPDX-License-Identifier: MIT
#include "robot/device_health.h"

#include <gtest/gtest.h>

namespace dynslam {
namespace {

using std::chrono::milliseconds;

Time at_ms(int ms) { return Time(milliseconds(ms)); }

struct Gauge : Device {
  std::string about() const override {
    ++asked;
    return name;
  }
  Counters counters() const override { return counted; }
  std::string name;
  Counters counted;
  mutable int asked = 0;
};

TEST(DeviceHealth, OfNoDeviceNothingIsShown) {
  Latest<DeviceHealth> shown;
  HealthKeeper keeper(nullptr, shown);
  EXPECT_EQ(shown.get().value, nullptr);
}

TEST(DeviceHealth, IsShownAtOnceWhenItIsNewsAndElseNowAndThen) {
  Gauge gauge;
  Latest<DeviceHealth> shown;
  HealthKeeper keeper(&gauge, shown);
  EXPECT_TRUE(shown.get().value->present);
  const auto samples = [&] { return shown.get().value->samples; };
  keeper.answered(at_ms(1000));
  EXPECT_EQ(samples(), 1U);
  for (int ms = 1010; ms < 1100; ms += 10) keeper.answered(at_ms(ms));
  EXPECT_EQ(samples(), 1U) << "not at each sample";
  keeper.answered(at_ms(1100));
  EXPECT_EQ(samples(), 11U);
  keeper.failed("gauge: it broke");
  EXPECT_EQ(shown.get().value->errors, 1U);
  EXPECT_EQ(shown.get().value->trouble, "gauge: it broke");
  EXPECT_EQ(shown.get().value->last_sample, at_ms(1100));
  keeper.answered(at_ms(1110));
  EXPECT_EQ(shown.get().value->trouble, "");
  EXPECT_EQ(samples(), 12U);
  keeper.answered(at_ms(400));
  EXPECT_EQ(samples(), 13U) << "the clock was set back";
}

TEST(DeviceHealth, TheDeviceIsAskedWhatItIsOnceASecondAndWhenItFails) {
  Gauge gauge;
  Latest<DeviceHealth> shown;
  HealthKeeper keeper(&gauge, shown);
  for (int ms = 0; ms < 3000; ms += 10) keeper.answered(at_ms(ms));
  EXPECT_EQ(gauge.asked, 3);
  gauge.name = "a gauge";
  gauge.counted.add("nak", 4);
  keeper.failed("gauge: it broke");
  EXPECT_EQ(shown.get().value->about, "a gauge");
  EXPECT_EQ(shown.get().value->counters["nak"], 4U);
}

}  // namespace
}  // namespace dynslam
