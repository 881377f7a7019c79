// SPDX-License-Identifier: MIT
// The autopilot's errand to find out what is there.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "autopilot/autopilot.h"
#include "autopilot/pilot.h"

namespace dynslam {
namespace {

TEST(Autopilot, ExploresEveryRoomAndEnds) {
  AutopilotSetup setup;
  setup.autopilot.when_explored = "stay";
  Pilot pilot(kFlat, setup);
  pilot.looks = true;
  const AutopilotStatus begun = pilot.turn(Explore{});
  EXPECT_EQ(begun.mode, AutopilotMode::kExploration);
  const AutopilotStatus ended = pilot.run();
  EXPECT_EQ(ended.phase, AutopilotPhase::kIdle);
  EXPECT_EQ(ended.reason, "everything within reach is mapped");
  EXPECT_EQ(pilot.building.world(pilot.now, pilot.at).map.state(cell_at(pilot.building.find('g'), 0.02)),
            CellState::kFree);
  EXPECT_LT(pilot.way_m, 12.0);
}

/// Explores, and the door between it and the other room was shut.
struct ShutIn : Pilot {
  ShutIn() : Pilot(kFlat, stays()) {
    looks = true;
    turn(Explore{});
    for (int i = 0; i < 8; ++i) turn();
    building.wall_up('d');
    shut_at = now;
  }
  static AutopilotSetup stays() {
    AutopilotSetup setup;
    setup.autopilot.when_explored = "stay";
    setup.autopilot.door_patience_s = 20.0;
    return setup;
  }
  double waited_s() const { return to_seconds(now - shut_at); }
  Time shut_at;
};

TEST(Autopilot, HopesThatAShutDoorOpensButNotForEver) {
  ShutIn pilot;
  const AutopilotStatus ended = pilot.run();
  EXPECT_EQ(ended.phase, AutopilotPhase::kIdle);
  EXPECT_EQ(ended.reason, "everything is mapped but what lies behind closed doors");
  EXPECT_GT(pilot.waited_s(), 20.0);
  EXPECT_LT(pilot.waited_s(), 30.0);
}

/// Who wants to come through, or to open the door to its side, would wait for the robot for ever.
TEST(Autopilot, DoesNotStandBeforeAShutDoorAllTheTime) {
  ShutIn pilot;
  const auto from_door_m = [&] { return pilot.away_m(pilot.building.find('d')); };
  double nearest_m = 100.0, aside_m = 0.0;
  for (; pilot.waited_s() < 20.0; pilot.turn()) {
    nearest_m = std::min(nearest_m, from_door_m());
    if (nearest_m < 0.7) aside_m = std::max(aside_m, from_door_m());
  }
  EXPECT_LT(nearest_m, 0.7);
  EXPECT_GT(aside_m, 1.2);
  EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kActive) << "it hopes still";
}

TEST(Autopilot, ExploresOnAtOnceWhenTheDoorOpensThatItHopedFor) {
  ShutIn pilot;
  while (pilot.waited_s() < 15.0) EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kActive);
  pilot.building.open('d');
  const AutopilotStatus ended = pilot.run();
  EXPECT_EQ(ended.reason, "everything within reach is mapped");
  EXPECT_LT(pilot.waited_s(), 45.0);
  EXPECT_EQ(pilot.building.world(pilot.now, pilot.at).map.state(cell_at(pilot.building.find('g'), 0.02)),
            CellState::kFree);
}

/// Seconds that it explores a corridor with chambers on both sides, that it sees through gaps too narrow for
/// it.
double seconds_among_gaps(double door_patience_s) {
  const int chambers = 5;
  std::string wall = "#", chamber = "#", gaps = "#", floor = "#";
  for (int i = 0; i < chambers; ++i)
    wall += "########", chamber += ".......#", gaps += "###.####", floor += "........";
  floor.back() = '#';
  std::vector<std::string> lines{wall};
  lines.insert(lines.end(), 8, chamber);
  lines.push_back(gaps);
  lines.insert(lines.end(), 6, floor);
  lines.push_back(gaps);
  lines.insert(lines.end(), 8, chamber);
  lines.push_back(wall);
  lines[12][2] = 's';
  AutopilotSetup setup = ShutIn::stays();
  setup.autopilot.door_patience_s = door_patience_s;
  Pilot pilot(lines, setup);
  pilot.looks = true;
  const Time begin = pilot.now;
  pilot.turn(Explore{});
  EXPECT_EQ(pilot.run().phase, AutopilotPhase::kIdle);
  return to_seconds(pilot.now - begin);
}

TEST(Autopilot, LooksForNoMoreThanItsPatienceIntoGapsThatItDoesNotFitInto) {
  EXPECT_LT(seconds_among_gaps(10.0), seconds_among_gaps(200.0) - 20.0);
}

const std::vector<std::string> kBetweenTwoRooms = {
    "##################################",  //
    "#..........#..........#..........#",  //
    "#..........#..........#..........#",  //
    "#..........#..........d..........#",  //
    "#..........e..........d..........#",  //
    "#..........e..........d..........#",  //
    "#..........e....s.....#..........#",  //
    "#..........#..........#..........#",  //
    "#..........#..........#..........#",  //
    "##################################",  //
};

/// Explores, is on its way into one of the two rooms, and then somebody stands in its door for so many turns.
struct WhileSomebodyIsInTheDoor : Pilot {
  explicit WhileSomebodyIsInTheDoor(int turns) : Pilot(kBetweenTwoRooms) {
    looks = true;
    turn(Explore{});
    goal_map = goal_after(6);
    const char door = goal_map.x() > at.x ? 'd' : 'e';
    building.wall_up(door);
    turned_m = (goal_after(turns) - goal_map).norm();
  }
  Vector2 goal_after(int turns) {
    for (int i = 1; i < turns; ++i) turn();
    return turn().goal.value().point_map;
  }
  Vector2 goal_map;
  double turned_m;
};

TEST(Autopilot, KeepsToItsAimWhileSomebodyWalksThroughTheDoor) {
  EXPECT_LT(WhileSomebodyIsInTheDoor(10).turned_m, 0.6);
}

TEST(Autopilot, ExploresElsewhereWhenSomebodyStaysInTheDoor) {
  EXPECT_GT(WhileSomebodyIsInTheDoor(30).turned_m, 3.0);
}

TEST(Autopilot, GoesHomeWhenAllIsExplored) {
  AutopilotSetup setup;
  setup.autopilot.when_explored = "home";
  Pilot pilot(kFlat, setup);
  pilot.looks = true;
  pilot.notes = std::make_shared<MapNotes>();
  pilot.notes->home = Destination{pilot.building.find('s'), {}, "the charger"};
  pilot.turn(Explore{});
  const AutopilotStatus ended = pilot.run();
  EXPECT_EQ(ended.phase, AutopilotPhase::kIdle);
  EXPECT_EQ(ended.reason, "arrived at the charger");
}

TEST(Autopilot, RevisitsWhatIsExploredForEver) {
  Pilot pilot(kFlat);
  pilot.looks = true;
  pilot.turn(Explore{});
  int explored = 0;
  for (int i = 0; i < 600; ++i) {
    EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kActive);
    explored += pilot.autopilot.is_explored() ? 1 : 0;
  }
  EXPECT_GT(explored, 50);
  EXPECT_GT(pilot.way_m, 10.0) << "it goes on";
}

}  // namespace
}  // namespace dynslam
