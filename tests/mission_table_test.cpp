// SPDX-License-Identifier: MIT
#include "mission_table.h"

#include <gmock/gmock.h>

namespace dynslam {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

nlohmann::json mission(int reached, int no_route_right) {
  return {{"contacts", 0},
          {"goals", {{"tried", 10}, {"reached", reached}, {"no_route_right", no_route_right}}},
          {"longest_wait_s", 4.0}};
}

TEST(MissionTable, SumsUpTheGoalsOfAllMissions) {
  MissionTable table;
  table.add_goals("apartment", 1, 10, mission(8, 2));
  table.add_goals("office", 2, 10, mission(7, 2));
  EXPECT_THAT(table.text(), HasSubstr("19 of 20 goals reached or rightly not: 95.0 %; 0 contacts"));
  EXPECT_THAT(table.text(), HasSubstr("longest wait with a free way 4.0 s"));
}

TEST(MissionTable, GoalsThatItDidNotComeToHaveFailed) {
  MissionTable table;
  table.add_goals("clutter", 1, 10, nlohmann::json());
  table.add_goals("clutter", 2, 10, mission(4, 0));
  EXPECT_THAT(table.text(), HasSubstr("4 of 20 goals"));
}

TEST(MissionTable, TellsContactsThatNobodyCouldSeeComing) {
  nlohmann::json bumpy = mission(10, 0);
  bumpy["contacts"] = 3;
  bumpy["contact_places"] = {{{"high_m", 0.07}}, {{"high_m", 0.5}}, nlohmann::json::object()};
  MissionTable table;
  table.add_goals("apartment", 1, 10, bumpy);
  EXPECT_THAT(table.text(), HasSubstr("3 contacts (1 with what is too low to be seen)"));
}

TEST(MissionTable, ComparesExplorationsWithTheYardstick) {
  MissionTable table;
  table.add_exploration("office", 3, 100.0, {{"time_s", 150.0}, {"reachable_floor_mapped", 0.991}});
  EXPECT_THAT(table.text(), HasSubstr("1.50"));
  EXPECT_THAT(table.text(), HasSubstr("99.10"));
  EXPECT_THAT(table.text(), Not(HasSubstr("goals")));
}

}  // namespace
}  // namespace dynslam
