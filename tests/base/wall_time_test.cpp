// SPDX-License-Identifier: MIT
#include "base/wall_time.h"

#include <gtest/gtest.h>

namespace dynslam {
namespace {

using std::chrono::seconds;

constexpr WallTime kEvening = std::chrono::sys_days(std::chrono::year(2026) / 11 / 26) + seconds(53101);

TEST(WallTime, IsReadFromANameAsItWasPutThere) {
  EXPECT_EQ(utc_text(kEvening), "20261126-144501");
  EXPECT_EQ(utc_text(kEvening, "%Y-%m-%dT%H:%M:%SZ"), "2026-11-26T14:45:01Z");
  for (const WallTime time : {WallTime{}, kEvening, kEvening + std::chrono::years(60)})
    EXPECT_EQ(time_in_name("notes-" + utc_text(time) + "-2.json"), time);
  for (const char* name : {"", "notes-7.json", "20261126-14450", "20261326-144501", "20260230-144501",
                           "20261126-244501", "20261126_144501"})
    EXPECT_EQ(time_in_name(name), std::nullopt) << name;
}

TEST(WallTime, NamesSortAsTheyWereGivenWhateverTheClockDoes) {
  std::vector<std::string> names;
  for (const WallTime now : {kEvening, kEvening, WallTime{}, kEvening - std::chrono::years(50),
                             kEvening + seconds(9), kEvening + seconds(10)})
    names.push_back(utc_text(time_after(names, now)));
  EXPECT_EQ(names, (std::vector<std::string>{"20261126-144501", "20261126-144502", "20261126-144503",
                                             "20261126-144504", "20261126-144510", "20261126-144511"}));
}

}  // namespace
}  // namespace dynslam
