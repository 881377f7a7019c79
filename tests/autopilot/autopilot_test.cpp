// SPDX-License-Identifier: MIT
#include "autopilot/autopilot.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "autopilot/pilot.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Autopilot, IsOffUntilItIsAskedForSomething) {
  KnownFlat pilot;
  EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kOff);
  EXPECT_FALSE(pilot.autopilot.task());
}

TEST(Autopilot, DrivesToAPlaceAndHasNothingToDoThere) {
  KnownFlat pilot;
  const Vector2 goal = pilot.building.find('g');
  const AutopilotStatus begun = pilot.turn(GoThere{{goal, 1.0, "sofa"}});
  EXPECT_EQ(begun.phase, AutopilotPhase::kActive);
  ASSERT_TRUE(begun.remaining_m);
  EXPECT_GT(*begun.remaining_m, 3.8);
  EXPECT_EQ(pilot.autopilot.task()->yaw_rad, 1.0);
  const AutopilotStatus ended = pilot.run();
  EXPECT_EQ(ended.phase, AutopilotPhase::kIdle);
  EXPECT_EQ(ended.reason, "arrived at sofa");
  EXPECT_LT(pilot.away_m(goal), 0.01);
}

TEST(Autopilot, SaysAtOnceThatAPlaceIsOutsideAndShowsTheNearestThatIsNot) {
  KnownFlat pilot;
  pilot.turn(GoThere{{{7.0, -5.0}}});
  const AutopilotStatus status = pilot.turn();
  EXPECT_EQ(status.phase, AutopilotPhase::kStopped);
  EXPECT_THAT(status.reason, HasSubstr("no route"));
  ASSERT_TRUE(status.nearest_map);
  EXPECT_FALSE(pilot.building.is_wall(*status.nearest_map));
  EXPECT_LT(pilot.way_m, 0.01);
}

TEST(Autopilot, WaitsForADoorThatClosesInMidDriveAndSaysSoWhenItStaysShut) {
  KnownFlat pilot;
  pilot.turn(GoThere{{pilot.building.find('g')}});
  for (int i = 0; i < 5; ++i) pilot.turn();
  pilot.building.wall_up('d');
  pilot.building.know_all();
  AutopilotStatus status = pilot.turn();
  for (int i = 0; i < 100 && pilot.autopilot.task(); ++i) status = pilot.turn();
  EXPECT_FALSE(pilot.autopilot.task()) << "it stands";
  EXPECT_GT(pilot.at.x, pilot.building.kLetter_m * 6) << "before the door, which it sees";
  status = pilot.turn();
  EXPECT_EQ(status.phase, AutopilotPhase::kActive);
  EXPECT_THAT(status.reason, Not(IsEmpty()));
  const Time shut = pilot.now;
  status = pilot.run();
  EXPECT_EQ(status.phase, AutopilotPhase::kStopped);
  EXPECT_THAT(status.reason, HasSubstr("no route"));
  EXPECT_GT(pilot.now - shut, std::chrono::seconds(10));
  EXPECT_LT(pilot.at.x, pilot.building.kLetter_m * 14);
}

TEST(Autopilot, LooksWhetherADoorThatWasShutIsStillSo) {
  KnownFlat pilot;
  pilot.building.wall_up('d');
  pilot.building.know_all();
  pilot.turn();
  pilot.turn(GoThere{{pilot.building.find('g'), 1.0}});
  ASSERT_TRUE(pilot.autopilot.task());
  EXPECT_FALSE(pilot.autopilot.task()->yaw_rad) << "of no matter before the door";
  for (int i = 0; i < 8; ++i) EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kActive);
  pilot.building.open('d');
  pilot.building.know_all();
  EXPECT_EQ(pilot.run().reason, "arrived");
  EXPECT_LT(pilot.away_m(pilot.building.find('g')), 0.01);
}

TEST(Autopilot, LooksAtTheOtherDoorWhenOneStaysShut) {
  Pilot pilot({
      "##############################",  //
      "#......................#.....#",  //
      "#..s...................#.....#",  //
      "#......................d..g..#",  //
      "#......................d.....#",  //
      "#......................d.....#",  //
      "#......................d.....#",  //
      "#......................#.....#",  //
      "#..........#############.....#",  //
      "#..........#.................#",  //
      "#..........e.................#",  //
      "#..........e.................#",  //
      "#..........e.................#",  //
      "#..........e.................#",  //
      "#..........#.................#",  //
      "##############################",  //
  });
  pilot.building.know_all();
  pilot.turn(GoThere{{pilot.building.find('g')}});
  for (const char door : {'d', 'e'}) pilot.building.wall_up(door);
  pilot.building.know_all();
  pilot.run_while([&] { return pilot.autopilot.task().has_value(); });
  EXPECT_GT(pilot.at.x, pilot.building.find('e').x());
  pilot.building.open('e');  // out of sight
  const auto status = pilot.run_while([&] { return pilot.away_m(pilot.building.find('e')) > 1.5; });
  ASSERT_EQ(status.phase, AutopilotPhase::kActive) << status.reason;
  pilot.building.know_all();
  EXPECT_EQ(pilot.run().reason, "arrived");
  EXPECT_LT(pilot.away_m(pilot.building.find('g')), 0.01);
}

TEST(Autopilot, SaysThatThereIsNoWayWhenAllDoorsStayShut) {
  Pilot pilot({
      "#####################",  //
      "#.........#.........#",  //
      "#.........d.........#",  //
      "#..s......d......g..#",  //
      "#.........d.........#",  //
      "#.........#.........#",  //
      "#.........#.........#",  //
      "#.........#.........#",  //
      "#.........#.........#",  //
      "#.........#.........#",  //
      "#.........#.........#",  //
      "#.........#.........#",  //
      "#.........e.........#",  //
      "#.........e.........#",  //
      "#.........e.........#",  //
      "#.........#.........#",  //
      "#####################",  //
  });
  pilot.building.know_all();
  pilot.turn(GoThere{{pilot.building.find('g')}});
  for (const char door : {'d', 'e'}) pilot.building.wall_up(door);
  pilot.building.know_all();
  const Time shut = pilot.now;
  double least_to_other_m = 100.0;
  const AutopilotStatus status = pilot.run_while([&] {
    least_to_other_m = std::min(least_to_other_m, pilot.away_m(pilot.building.find('e')));
    return true;
  });
  EXPECT_EQ(status.phase, AutopilotPhase::kStopped);
  EXPECT_THAT(status.reason, HasSubstr("no route"));
  EXPECT_LT(least_to_other_m, 1.5);
  EXPECT_LT(pilot.now - shut, std::chrono::seconds(45)) << "each is waited for once";
}

/// It stands before the door 'd' that is shut; the leaf of that is 'l' when it stands open.
struct BeforeADoor : Pilot {
  explicit BeforeADoor(char stands_at)
      : Pilot({
            "##############################",  //
            "#.............#..............#",  //
            "#.............#..............#",  //
            "#......s......#..............#",  //
            "#.............#..............#",  //
            "#.............#..............#",  //
            "#.............#..............#",  //
            "#.............#..............#",  //
            "#.............#..............#",  //
            "#.............#..............#",  //
            "#........lllll#..............#",  //
            "#.............d......g.......#",  //
            "#.............d..............#",  //
            "#...........t.d..............#",  //
            "#.............d..............#",  //
            "#.............#..............#",  //
            "#.............#..............#",  //
            "##############################",  //
        }) {
    at.x = building.find(stands_at).x();
    at.y = building.find(stands_at).y();
    building.know_all();
    glides = false;
    turn(GoThere{{building.find('g')}});
    glides = true;
    building.wall_up('d');
    building.know_all();
  }
};

TEST(Autopilot, ComesUpToADoorWhoseLeafHidesThatItIsOpen) {
  BeforeADoor pilot('s');
  pilot.run_while([&] { return pilot.autopilot.task().has_value(); });
  ASSERT_GT(pilot.at.y, pilot.building.find('l').y() + 0.3) << "behind where the leaf will be";
  pilot.building.open('d');
  pilot.building.wall_up('l');
  pilot.looks = true;
  EXPECT_EQ(pilot.run().reason, "arrived");
}

TEST(Autopilot, LeavesADoorwayWhereTheDoorCouldNotMove) {
  BeforeADoor pilot('t');
  for (int i = 0; i < 9; ++i) pilot.turn();
  EXPECT_LT(pilot.way_m, 0.15) << "who is about to open it needs no room yet";
  for (int i = 0; i < 12; ++i) EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kActive);
  EXPECT_GT(pilot.away_m(pilot.building.find('d')), 1.1);
}

/// It is boxed in until 'b' is opened.
struct BoxedIn : Pilot {
  explicit BoxedIn(const std::vector<std::string>& lines) : Pilot(lines) {
    building.know_all();
    glides = false;
    turn(GoThere{{building.find('g')}});
    turn();
    glides = true;
    building.wall_up('b');
    building.know_all();
    out = building.find('b');
  }
  void let_out() {
    building.open('b');
    building.know_all();
  }
  Vector2 out;
};

const std::vector<std::string> kPocket = {
    "########################################",  //
    "##########..............#..............#",  //
    "##########..............#..............#",  //
    "##.......b..............d.......g......#",  //
    "##......sb..............d..............#",  //
    "##.......b..............d..............#",  //
    "##########..............#..............#",  //
    "##########..............#..............#",  //
    "########################################",  //
};

/// Who stands there goes on when the robot is out of the way.
TEST(Autopilot, MakesRoomForWhoStandsInTheOnlyWayOut) {
  BoxedIn pilot(kPocket);
  const Time shut = pilot.now;
  const auto status = pilot.run_while([&] { return pilot.away_m(pilot.out) < 1.0; });
  ASSERT_EQ(status.phase, AutopilotPhase::kActive) << status.reason;
  EXPECT_GT(pilot.now - shut, std::chrono::seconds(2)) << "who only passes by need not be made room for";
  for (int i = 0; i < 60; ++i) EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kActive);
  EXPECT_GT(pilot.away_m(pilot.out), 1.0) << "it stays out of the way";
  pilot.let_out();
  EXPECT_EQ(pilot.run().reason, "arrived");
}

TEST(Autopilot, DoesNotMakeRoomAnyMoreWhenTheWayIsFree) {
  BoxedIn pilot(kPocket);
  pilot.run_while([&] { return pilot.away_m(pilot.out) < 0.6; });
  pilot.let_out();
  pilot.run_while([&] { return pilot.at.x < pilot.out.x() + 1.5; });
  pilot.building.wall_up('d');
  pilot.building.know_all();
  double least_x = pilot.at.x;
  const auto status = pilot.run_while([&] {
    least_x = std::min(least_x, pilot.at.x);
    return true;
  });
  EXPECT_THAT(status.reason, HasSubstr("no route"));
  EXPECT_GT(least_x, pilot.out.x() + 1.0) << "the pocket was long left";
}

TEST(Autopilot, DoesNotMakeRoomTowardsTheWayOut) {
  BoxedIn pilot({
      "##############################",  //
      "##########...................#",  //
      "##########...................#",  //
      "####.....b...............g...#",  //
      "####.s...b...................#",  //
      "####.....b...................#",  //
      "##########...................#",  //
      "##########...................#",  //
      "##############################",  //
  });
  const double away_m = pilot.away_m(pilot.out);
  const auto status = pilot.run_while([&] { return pilot.away_m(pilot.out) > away_m - 0.1; });
  EXPECT_EQ(status.phase, AutopilotPhase::kStopped) << "it drove to where somebody stands";
  EXPECT_THAT(status.reason, HasSubstr("no route"));
}

/// Beside its destination something holds it, though its map says that there is room.
TEST(Autopilot, ContentsItselfWithAPlaceWhereItIsHeldBesideItsDestination) {
  KnownFlat pilot;
  const Vector2 goal = pilot.building.find('g');
  pilot.turn(GoThere{{goal}});
  while (pilot.away_m(goal) > 0.2) ASSERT_EQ(pilot.turn().phase, AutopilotPhase::kActive);
  pilot.glides = false;
  const Time held = pilot.now;
  AutopilotStatus status;
  do {
    pilot.follow.state = Following::kBlocked;
    pilot.follow.reason = "something is in the way";
    const bool stirs = (pilot.now - held) % std::chrono::seconds(2) >= std::chrono::milliseconds(400);
    if (stirs) pilot.follow.state = Following::kDriving;
    status = pilot.turn();
  } while (status.phase == AutopilotPhase::kActive && pilot.now - held < std::chrono::seconds(60));
  EXPECT_EQ(status.reason, "arrived, as near as it can come: something is in the way");
  EXPECT_LT(pilot.now - held, std::chrono::seconds(12)) << "it stirs now and then";
  EXPECT_GT(pilot.now - held, std::chrono::seconds(6));
}

TEST(Autopilot, DrivesOnWhenTheDoorOpensAgain) {
  KnownFlat pilot;
  pilot.turn(GoThere{{pilot.building.find('g')}});
  pilot.building.wall_up('d');
  pilot.building.know_all();
  for (int i = 0; i < 20; ++i) pilot.turn();
  pilot.building.open('d');
  pilot.building.know_all();
  EXPECT_EQ(pilot.run().phase, AutopilotPhase::kIdle);
}

TEST(Autopilot, WaitsForWhoStandsAtItsDestinationAndThenGoesThere) {
  KnownFlat pilot;
  const Vector2 goal = pilot.building.find('g') + Vector2(0.2, 0.0);
  pilot.turn(GoThere{{goal}});
  for (int i = 0; i < 5; ++i) pilot.turn();
  pilot.building.wall_up('g');
  pilot.building.know_all();
  for (int i = 0; i < 300 && pilot.follow.state != Following::kArrived; ++i)
    ASSERT_EQ(pilot.turn().phase, AutopilotPhase::kActive);
  EXPECT_GT(pilot.away_m(goal), 0.1);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kActive);
  pilot.building.open('g');
  pilot.building.know_all();
  EXPECT_EQ(pilot.run().reason, "arrived");
  EXPECT_LT(pilot.away_m(goal), 0.01);
}

TEST(Autopilot, ContentsItselfWithAPlaceNearbyWhenItsDestinationStaysTaken) {
  KnownFlat pilot;
  const Vector2 goal = pilot.building.find('g') + Vector2(0.2, 0.0);
  pilot.turn(GoThere{{goal}});
  pilot.building.wall_up('g');
  pilot.building.know_all();
  for (int i = 0; i < 300 && pilot.follow.state != Following::kArrived; ++i) pilot.turn();
  const Time there = pilot.now;
  EXPECT_THAT(pilot.run().reason, HasSubstr("as near as it can come"));
  EXPECT_GT(pilot.now - there, std::chrono::seconds(7));
  EXPECT_LT(pilot.now - there, std::chrono::seconds(10));
  EXPECT_LT(pilot.away_m(goal), 0.5);
}

TEST(Autopilot, DoesNotWaitLongForWhatTakesUpAllAroundItsDestination) {
  Pilot pilot({
      "##############################",  //
      "#.............#..............#",  //
      "#............................#",  //
      "#..s..................bbbbb..#",  //
      "#.....................bbgbb..#",  //
      "#.....................bbbbb..#",  //
      "#.............#.......bbbbb..#",  //
      "##############################",  //
  });
  pilot.building.know_all();
  pilot.turn(GoThere{{pilot.building.find('g')}});
  for (int i = 0; i < 5; ++i) pilot.turn();
  pilot.building.wall_up('b');
  pilot.building.know_all();
  const Time taken = pilot.now;
  EXPECT_THAT(pilot.run().reason, HasSubstr("no route"));
  EXPECT_GT(pilot.now - taken, std::chrono::seconds(7));
  EXPECT_LT(pilot.now - taken, std::chrono::seconds(16)) << "though it waits for a door for longer";
}

TEST(Autopilot, WhoTakesTheWheelEndsIt) {
  KnownFlat pilot;
  pilot.turn(GoThere{{pilot.building.find('g')}});
  pilot.steered = true;
  const AutopilotStatus status = pilot.turn();
  EXPECT_EQ(status.phase, AutopilotPhase::kOff);
  EXPECT_EQ(status.reason, "a person took the wheel");
  EXPECT_FALSE(pilot.autopilot.task());
}

TEST(Autopilot, AStopEndsItAndClearingTheStopDoesNotSetItOff) {
  KnownFlat pilot;
  pilot.turn(GoThere{{pilot.building.find('g')}});
  pilot.condition.verdict = {Motion::kEStop, "stopped by Ann"};
  pilot.condition.cause = Cause::kStopAsked;
  EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kStopped);
  pilot.condition.verdict = {};
  pilot.condition.verdict.motion = Motion::kGo;
  const AutopilotStatus status = pilot.turn();
  EXPECT_EQ(status.phase, AutopilotPhase::kStopped);
  EXPECT_EQ(status.reason, "stopped by Ann");
  EXPECT_EQ(pilot.turn(GoThere{{pilot.building.find('g')}}).phase, AutopilotPhase::kActive);
}

TEST(Autopilot, ATouchEndsItWhereItMayNotBackOff) {
  AutopilotSetup setup;
  setup.autopilot.most_touches = 0;
  KnownFlat pilot(setup);
  pilot.turn(Explore{});
  pilot.condition.touches = true;
  const AutopilotStatus status = pilot.turn();
  EXPECT_EQ(status.phase, AutopilotPhase::kStopped);
  EXPECT_EQ(status.reason, "it touched something");
}

/// A robot that ran into something at its start, driving ahead, and backs off for as long as it is told to.
struct Touching : KnownFlat {
  Touching() {
    came = {0.3, 0.0};
    turn(GoThere{{building.find('g')}});
    condition.touches = true;
  }
  double back_off(bool comes_free) {
    const Time begin = now;
    while (turn().phase == AutopilotPhase::kActive && autopilot.backs_off()) {
      EXPECT_FALSE(autopilot.task()) << "no route is driven meanwhile";
      condition.touches = condition.touches && !comes_free;
      if (now - begin > std::chrono::seconds(10)) return 10.0;
    }
    return to_seconds(now - begin);
  }
};

TEST(Autopilot, BacksOffFromATouchAndDrivesRoundWhatItFelt) {
  Touching pilot;
  const Vector2 felt = pilot.at * Vector2(0.26, 0.0);
  EXPECT_NEAR(pilot.back_off(true), 2.2, 0.5);
  double nearest_m = 9.0;
  AutopilotStatus status = pilot.turn();
  for (int i = 0; i < 300 && status.phase == AutopilotPhase::kActive; ++i) {
    if (pilot.way_m > 0.3) nearest_m = std::min(nearest_m, pilot.away_m(felt));
    status = pilot.turn();
  }
  EXPECT_EQ(status.reason, "arrived");
  EXPECT_GT(nearest_m, 0.3);
}

TEST(Autopilot, WhatItFeltDoesNotShutTheOnlyWayButIsNotForgotten) {
  Touching pilot;
  // Before the only door; what it touches lies in the middle of that.
  const Vector2 door = pilot.building.find('d') + Vector2(0.1, -0.2);
  pilot.at = {door.x() - 0.3, door.y(), 0.0};
  pilot.back_off(true);
  EXPECT_EQ(pilot.run().reason, "arrived");
  EXPECT_GT(pilot.at.x, door.x()) << "through the door all the same";
  // Where there is a way round it, that is taken.
  pilot.building.open('#');
  pilot.building.know_all();
  pilot.turn(GoThere{{door - Vector2(1.0, 0.0)}});
  double nearest_m = 9.0;
  while (pilot.autopilot.task() && pilot.way_m < 20.0) {
    nearest_m = std::min(nearest_m, pilot.away_m(door));
    pilot.turn();
  }
  EXPECT_GT(nearest_m, 0.25);
  EXPECT_LT(nearest_m, 1.0);
}

TEST(Autopilot, ATouchThatDoesNotEndEndsIt) {
  Touching pilot;
  EXPECT_LT(pilot.back_off(false), 3.0);
  const AutopilotStatus status = pilot.turn();
  EXPECT_EQ(status.phase, AutopilotPhase::kStopped);
  EXPECT_EQ(status.reason, "it touched something");
}

TEST(Autopilot, ToTouchTooOftenEndsIt) {
  Touching pilot;
  for (int i = 0; i < 3; ++i) {
    pilot.condition.touches = true;
    pilot.back_off(true);
    EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kActive) << i;
  }
  pilot.condition.touches = true;
  EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kStopped);
}

TEST(Autopilot, BacksOffFromWhatHoldsItThoughNoBumperTellsOfThat) {
  KnownFlat pilot;
  pilot.came = {0.3, 0.0};
  pilot.turn(GoThere{{pilot.building.find('g')}});
  for (int i = 0; i < 3; ++i) {
    pilot.follow.state = Following::kStuck;
    const AutopilotStatus status = pilot.turn();
    EXPECT_EQ(status.phase, AutopilotPhase::kActive) << i;
    EXPECT_EQ(status.reason, "the wheels turn and the robot stays, and backs off");
    EXPECT_TRUE(pilot.autopilot.backs_off());
    while (pilot.autopilot.backs_off()) pilot.turn();
    for (int n = 0; n < 200 && !pilot.autopilot.task(); ++n) pilot.turn();
    ASSERT_TRUE(pilot.autopilot.task()) << "it tries another way";
  }
  pilot.follow.state = Following::kStuck;
  EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kStopped) << "a person has to look";
}

TEST(Autopilot, AStopEndsBackingOff) {
  Touching pilot;
  pilot.turn();
  ASSERT_TRUE(pilot.autopilot.backs_off());
  pilot.condition.verdict = {Motion::kEStop, "stopped by Ann"};
  pilot.condition.cause = Cause::kStopAsked;
  EXPECT_EQ(pilot.turn().reason, "stopped by Ann");
  EXPECT_FALSE(pilot.autopilot.backs_off());
}

TEST(Autopilot, ALidarThatIsGoneIsWaitedForButNotForEver) {
  KnownFlat pilot;
  pilot.turn(GoThere{{pilot.building.find('g')}});
  pilot.condition.verdict = {Motion::kStop, "no scan for 0.5 s"};
  pilot.condition.cause = Cause::kScan;
  pilot.glides = false;
  const AutopilotStatus status = pilot.turn();
  EXPECT_EQ(status.phase, AutopilotPhase::kActive);
  EXPECT_EQ(status.reason, "no scan for 0.5 s");
  const AutopilotStatus later = pilot.run();
  EXPECT_EQ(later.phase, AutopilotPhase::kStopped);
  EXPECT_EQ(later.reason, "no scan for 0.5 s");
}

TEST(Autopilot, LooksRoundWhenItIsLostAndGoesOnWhenItIsFound) {
  KnownFlat pilot;
  pilot.turn(GoThere{{pilot.building.find('g')}});
  pilot.lost = true;
  pilot.turn();
  EXPECT_NE(pilot.autopilot.look_round_radps(), 0.0);
  pilot.lost = false;
  pilot.turn();
  EXPECT_EQ(pilot.autopilot.look_round_radps(), 0.0);
  EXPECT_EQ(pilot.run().phase, AutopilotPhase::kIdle);
}

TEST(Autopilot, DrivesHomeWithTheLastOfItsBattery) {
  KnownFlat pilot;
  pilot.notes = std::make_shared<MapNotes>();
  pilot.notes->home = Destination{pilot.building.find('s'), {}, "the charger"};
  pilot.turn(GoThere{{pilot.building.find('g')}});
  for (int i = 0; i < 20; ++i) pilot.turn();
  pilot.condition.battery = BatteryLevel::kRecharge;
  const AutopilotStatus status = pilot.run();
  EXPECT_EQ(status.phase, AutopilotPhase::kStopped);
  EXPECT_THAT(status.reason, HasSubstr("battery"));
  EXPECT_LT(pilot.away_m(pilot.building.find('s')), 0.01);
}

TEST(Autopilot, WithoutAHomeItStopsWhenTheBatteryEnds) {
  KnownFlat pilot;
  pilot.turn(GoThere{{pilot.building.find('g')}});
  pilot.condition.battery = BatteryLevel::kRecharge;
  const AutopilotStatus status = pilot.turn();
  EXPECT_EQ(status.phase, AutopilotPhase::kStopped);
  EXPECT_THAT(status.reason, HasSubstr("battery"));
}

TEST(Autopilot, KeepsOutOfForbiddenAreas) {
  KnownFlat pilot;
  pilot.notes = std::make_shared<MapNotes>();
  pilot.notes->forbidden_map = {{{2.4, 0.0}, {3.2, 0.0}, {3.2, 2.0}, {2.4, 2.0}}};  // across the door
  pilot.turn(GoThere{{pilot.building.find('g')}});
  EXPECT_EQ(pilot.run().phase, AutopilotPhase::kStopped);
  pilot.notes = std::make_shared<MapNotes>();
  pilot.turn(GoThere{{pilot.building.find('g')}});
  EXPECT_EQ(pilot.run().phase, AutopilotPhase::kIdle);
}

TEST(Autopilot, PatrolsAndLeavesOutWhatItCannotReach) {
  KnownFlat pilot;
  const Vector2 first = pilot.building.find('g'), second = pilot.building.find('s');
  pilot.turn(Patrol{{{first, {}, "a"}, {{50.0, 50.0}, {}, "nowhere"}, {second, {}, "b"}}});
  int at_first = 0, at_second = 0;
  bool was_first = false;
  for (int i = 0; i < 1500; ++i) {
    pilot.turn();
    if (!was_first && pilot.away_m(first) < 0.02) ++at_first, was_first = true;
    if (was_first && pilot.away_m(second) < 0.02) ++at_second, was_first = false;
  }
  EXPECT_GE(at_first, 2);
  EXPECT_GE(at_second, 2);
}

TEST(Autopilot, APatrolOfPlacesThatCannotBeReachedEnds) {
  KnownFlat pilot;
  pilot.turn(Patrol{{{{50.0, 50.0}, {}, "x"}, {{-50.0, 50.0}, {}, "y"}}});
  EXPECT_EQ(pilot.run().phase, AutopilotPhase::kStopped);
  pilot.turn(Patrol{});
  EXPECT_EQ(pilot.turn().phase, AutopilotPhase::kStopped);
}

TEST(Autopilot, WithoutAMapItSaysWhatItWaitsFor) {
  Autopilot autopilot({});
  const std::vector<Order> orders = {Explore{}};
  const AutopilotStatus& status = autopilot.turn(Time(std::chrono::seconds(1)), {orders, nullptr});
  EXPECT_EQ(status.phase, AutopilotPhase::kActive);
  EXPECT_EQ(status.reason, "there is no map yet");
}

}  // namespace
}  // namespace dynslam
