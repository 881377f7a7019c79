// SPDX-License-Identifier: MIT
#include "drive/path_follower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "drive/toy_robot.h"

namespace dynslam {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// As a MonsterBorg on a floor that is not the one it was measured on.
constexpr ToyFaults kReal{0.9, 0.85, 0.18, 0.25, 0.01, 0.0087, 100, true, true};

DriveTask route(std::vector<Vector2> points, std::optional<double> yaw = {}) {
  return {1, std::move(points), yaw, 0.5, true};
}
double off_goal_m(const ToyRobot& robot, const Vector2& goal) {
  return (robot.pose.translation() - goal).norm();
}

/// How far a place is from a route.
double off_route_m(const Route& route, const Pose2& pose) {
  return route.nearest(pose.translation(), 0.0, route.length_m()).away_m;
}

void expect_sane(const ToyRobot& robot) {
  EXPECT_EQ(robot.unfree_commands, 0);
  EXPECT_EQ(robot.nonsense, 0);
}

/// Drives the route to its end; returns the farthest it was from it.
double drive(ToyRobot& robot, const DriveTask& task, double most_s) {
  const Route line(task.route_map);
  double farthest = 0.0;
  robot.follower.follow(task);
  const FollowOutput out = robot.run(most_s, [&](const FollowOutput& o) {
    farthest = std::max(farthest, off_route_m(line, robot.pose));
    return o.state == Following::kArrived;
  });
  EXPECT_EQ(out.state, Following::kArrived)
      << to_string(out.state) << ": " << out.reason << ", " << out.remaining_m << " m left";
  robot.run_on(1.0);
  EXPECT_LT(off_goal_m(robot, task.route_map.back()), 0.05);
  EXPECT_LT(std::abs(turn(robot.pose.yaw, task.yaw_rad.value_or(robot.pose.yaw))), radians(5));
  EXPECT_FALSE(is_moving(robot.wanted));
  EXPECT_EQ(robot.backwards, 0);
  expect_sane(robot);
  return farthest;
}

TEST(PathFollower, DrivesStraightInTime) {
  for (const ToyFaults& faults : {ToyFaults{}, kReal}) {
    ToyRobot robot({}, faults);
    EXPECT_LT(drive(robot, route({{0, 0}, {10, 0}}), 25.0), 0.06);
    EXPECT_EQ(robot.turned_on_spot_s, 0.0);
    EXPECT_LE(robot.turn_changes, 10);
  }
}

///     |      The inner corner of the walls stands 25 cm off the route.
///  ---+   |
///         |
///  -------+
TEST(PathFollower, TurnsACornerWithoutTouchingIt) {
  const DrawnWorld corridor{
      {{-1, 0.3, 2.7, 0.3}, {2.7, 0.3, 2.7, 4}, {-1, -0.3, 3.3, -0.3}, {3.3, -0.3, 3.3, 4}}, {}};
  for (const ToyFaults& faults : {ToyFaults{}, kReal}) {
    ToyRobot robot(corridor, faults);
    EXPECT_LT(drive(robot, route({{0, 0}, {3, 0}, {3, 3}}), 25.0), 0.15);
    EXPECT_GT(robot.least_gap_m, 0.03);
    EXPECT_LT(robot.turned_on_spot_s, 0.5) << "corners are rounded";
  }
}

std::vector<Vector2> snake() {
  std::vector<Vector2> points;
  for (double x = 0.0; x <= 6.0; x += 0.1) points.emplace_back(x, 0.5 * std::sin(1.5 * x));
  return points;
}

TEST(PathFollower, FollowsASnake) {
  for (const ToyFaults& faults : {ToyFaults{}, kReal}) {
    ToyRobot robot({}, faults, {0, 0, 0.6});
    EXPECT_LT(drive(robot, route(snake()), 30.0), 0.15);
    EXPECT_LE(robot.turn_changes, 4 + robot.driven_m) << "four bends";
  }
}

/// 1 cm and half a degree of noise, on poses of 100 ms ago.
TEST(PathFollower, DoesNotOscillate) {
  for (unsigned seed = 1; seed <= 5; ++seed)
    for (const bool extrapolates : {true, false}) {
      ToyFaults faults;
      faults.pose_noise_m = 0.01;
      faults.pose_noise_rad = radians(0.5);
      faults.pose_age_ms = 100;
      faults.extrapolates = extrapolates;
      ToyRobot robot({}, faults, {0, 0.1, 0.2}, seed);
      drive(robot, route({{0, 0}, {8, 0}}), 30.0);
      EXPECT_LE(robot.turn_changes, 8) << "once a metre, seed " << seed;
    }
}

TEST(PathFollower, TurnsRoundFirstWhenItFacesAway) {
  for (const double yaw : {kPi, -3.0, 2.0, -1.8}) {
    ToyRobot robot({}, kReal, {0, 0, yaw});
    EXPECT_LT(drive(robot, route({{0, 0}, {3, 0}}), 20.0), 0.1) << yaw;
    EXPECT_GT(robot.turned_on_spot_s, 0.5) << yaw;
  }
  ToyRobot robot({}, kReal, {0, 0, radians(70)});
  drive(robot, route({{0, 0}, {3, 0}}), 20.0);
  EXPECT_EQ(robot.turned_on_spot_s, 0.0) << "what can be driven as an arc is";
}

/// A wall at x = 2 with a door in it.
DrawnWorld door(double width) {
  return {{{2, width / 2, 2, 3},
           {2, -width / 2, 2, -3},
           {2.1, width / 2, 2.1, 3},
           {2.1, -width / 2, 2.1, -3},
           {2, width / 2, 2.1, width / 2},
           {2, -width / 2, 2.1, -width / 2}},
          {}};
}

TEST(PathFollower, PassesANarrowDoor) {
  for (const double width : {0.8, 0.5, 0.4}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      ToyRobot robot(door(width), kReal, {0, 0.8, 0}, seed);
      drive(robot, route({{0, 0.8}, {1.4, 0}, {4, 0}}), 40.0);
      EXPECT_GT(robot.least_gap_m, 0.01) << width;
    }
  }
}

TEST(PathFollower, LooksTheWantedWayInTheEnd) {
  for (const double yaw : {0.0, 1.5, -1.5, 3.1, -2.5}) {
    ToyRobot robot({}, kReal);
    drive(robot, route({{0, 0}, {1.5, 0.5}}, yaw), 20.0);
  }
}

TEST(PathFollower, TurnsOnlyWhenItIsThereAlready) {
  ToyRobot robot({}, kReal);
  drive(robot, route({{0, 0}}, 2.0), 10.0);
  EXPECT_LT(robot.driven_m, 0.05);
}

TEST(PathFollower, ComesToGoalsNearbyInAllDirections) {
  for (double angle = 0.0; angle < 6.2; angle += 0.7)
    for (const double away : {0.08, 0.15, 0.4}) {
      ToyRobot robot({}, kReal);
      const Vector2 goal(away * std::cos(angle), away * std::sin(angle));
      drive(robot, route({{0, 0}, goal}), 15.0);
    }
}

/// What it touched as it turned left is too low for its lidar.
TEST(PathFollower, DoesNotTurnAgainIntoWhatItTouched) {
  PathFollower follower;
  const RecentMotion motion;
  Time now{};
  const auto turn_of = [&](const Pose2& pose) {
    now += std::chrono::milliseconds(50);
    follower.see(scan_of({}, now), motion);
    return follower.next({now, pose, {}}, motion).twist.w_radps;
  };
  const DriveTask behind_left = route({{0, 0}, {-3, 1}});
  follower.follow(behind_left);
  EXPECT_GT(turn_of({0, 0, 0.0}), 0.0);
  EXPECT_GT(turn_of({0, 0, 0.8}), 0.0);
  follower.feel(true);
  EXPECT_EQ(turn_of({0, 0, 0.9}), 0.0) << "while it touches";
  follower.feel(false);
  for (const double yaw : {0.9, 0.6, 0.3}) {  // it backed off
    follower.halt();
    follower.follow(behind_left);
    EXPECT_LT(turn_of({0, 0, yaw}), 0.0) << yaw << ": the other way round";
  }
  for (double yaw = 0.0; yaw > -kPi; yaw -= 0.2) EXPECT_LT(turn_of({0, 0, yaw}), 0.0) << yaw;
  EXPECT_LT(turn_of({0, 0, kPi - 0.1}), 0.0);
  follower.follow(behind_left);
  EXPECT_GT(turn_of({0.2, 0, 0.3}), 0.0) << "here it may turn";
}

TEST(PathFollower, PassingALookOutIsEnough) {
  ToyRobot robot({}, ToyFaults{});
  DriveTask task = route({{0, 0}, {3, 0}});
  task.stops_at_end = false;
  robot.follower.follow(task);
  const FollowOutput out = robot.run_to_end(10.0);
  EXPECT_EQ(out.state, Following::kArrived);
  EXPECT_NEAR(off_goal_m(robot, {3, 0}), 0.25, 0.05);
  EXPECT_GT(robot.twist.v_mps, 0.4) << "it did not slow down for it";
}

TEST(PathFollower, WaitsForAPersonAndGoesOn) {
  ToyRobot robot({}, kReal);
  robot.world.walls = {{-1, 0.4, 6, 0.4}, {-1, -0.4, 6, -0.4}, {6, -0.4, 6, 0.4}};  // no way round
  robot.follower.follow(route({{0, 0}, {5, 0}}));
  robot.run_on(3.0);
  robot.world.posts = {{robot.pose.x + 0.8, 0, 0.2}};
  const auto waits = [](const FollowOutput& o) { return o.state == Following::kWaiting; };
  FollowOutput out = robot.run(5.0, waits);
  EXPECT_EQ(out.state, Following::kWaiting);
  EXPECT_FALSE(out.reason.empty());
  robot.run_on(1.0);
  EXPECT_GT(robot.least_gap_m, 0.03);
  robot.world.posts.clear();
  out = robot.run_to_end(20.0);
  EXPECT_EQ(out.state, Following::kArrived);
  expect_sane(robot);
}

TEST(PathFollower, SaysWhenItIsBlockedForGoodAndGoesOnWhenItIsNot) {
  ToyRobot robot({{{-1, 0.4, 6, 0.4}, {-1, -0.4, 6, -0.4}, {6, -0.4, 6, 0.4}}, {{2.5, 0, 0.25}}}, kReal);
  robot.follower.follow(route({{0, 0}, {5, 0}}));
  FollowOutput out = robot.run_to_end(20.0);
  EXPECT_EQ(out.state, Following::kBlocked);
  EXPECT_FALSE(is_moving(out.twist));
  EXPECT_GT(robot.pose.x, 1.7);
  EXPECT_GT(robot.least_gap_m, 0.03);
  robot.follower.follow(route({robot.pose.translation(), {5, 0}}));
  EXPECT_EQ(robot.tick().state, Following::kBlocked) << "the same way again is no better";
  robot.world.posts.clear();
  out = robot.run(20.0, [](const FollowOutput& o) { return o.state == Following::kArrived; });
  EXPECT_EQ(out.state, Following::kArrived);
  expect_sane(robot);
}

TEST(PathFollower, PassesAThingThatStandsALittleInTheWay) {
  ToyRobot robot({{}, {{2.0, 0.2, 0.1}}}, kReal);
  const double off = drive(robot, route({{0, 0}, {4, 0}}), 25.0);
  EXPECT_GT(robot.least_gap_m, 0.01);
  EXPECT_LT(off, 0.3);
}

/// Posts at random, routes straight through them: whatever comes of it, it touches nothing.
TEST(PathFollower, RunsIntoNothingHoweverBadTheRoute) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-2.5, 2.5), yaw(-kPi, kPi), size(0.02, 0.3);
  int arrived = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    DrawnWorld clutter{{{-3, -3, 3, -3}, {3, -3, 3, 3}, {3, 3, -3, 3}, {-3, 3, -3, -3}}, {}};
    while (clutter.posts.size() < 12) {
      const DrawnWorld::Post post{place(random), place(random), size(random)};
      if (std::hypot(post.x, post.y) > post.radius + 0.3) clutter.posts.push_back(post);
    }
    ToyRobot robot(clutter, kReal, {0, 0, yaw(random)}, seed);
    for (std::uint64_t id = 1; id <= 3; ++id) {
      robot.follower.follow({id, {robot.pose.translation(), {place(random), place(random)}}, {}, 0.5, true});
      arrived += robot.run_to_end(15.0).state == Following::kArrived ? 1 : 0;
    }
    EXPECT_GT(robot.least_gap_m, 0.0) << seed;
    expect_sane(robot);
  }
  EXPECT_GE(arrived, 6) << "of 24";
}

TEST(PathFollower, TurnsTheOtherWayWhenACornerWouldTouch) {
  // Close before the corner that would swing out to the left; and no room behind.
  ToyRobot robot({{{0.08, 0.132, 0.1, 0.132}, {-0.16, 0.0, -0.16, 0.02}}, {}}, ToyFaults{});
  robot.follower.follow(route({{0, 0}, {-1, 1.5}}));
  const FollowOutput out = robot.tick();
  EXPECT_EQ(out.state, Following::kTurning) << out.reason;
  EXPECT_LT(out.twist.w_radps, 0.0);
  expect_sane(robot);
}

TEST(PathFollower, BacksOutOfADeadEndThatIsTooNarrowForATurn) {
  // Seen from above, the robot's nose to the right:
  //           |_____
  //                 |
  //            _____|
  //           |
  const DrawnWorld dead_end{{{-0.1, 0.16, 0.2, 0.16},
                             {-0.1, -0.16, 0.2, -0.16},
                             {0.2, -0.16, 0.2, 0.16},
                             {-0.1, 0.16, -0.1, 1},
                             {-0.1, -0.16, -0.1, -1}},
                            {}};
  for (const ToyFaults& faults : {ToyFaults{}, kReal}) {
    ToyRobot robot(dead_end, faults);
    // Where it says that it is blocked, whoever knows the map sends it again.
    Following state = Following::kBlocked;
    for (int i = 0; i < 3 && state == Following::kBlocked; ++i) {
      robot.follower.follow(route({robot.pose.translation(), {-0.6, 0}, {-0.6, 1.5}}));
      state = robot.run_to_end(20.0).state;
    }
    EXPECT_EQ(state, Following::kArrived);
    EXPECT_LT(off_goal_m(robot, {-0.6, 1.5}), 0.06);
    EXPECT_GT(robot.least_gap_m, 0.005);
    EXPECT_EQ(robot.unfree_commands, 0);
    EXPECT_GT(robot.backwards, 0);
    EXPECT_LT(robot.backwards, 120) << "no farther than it must";
  }
}

TEST(PathFollower, ArrivesWhereItHasNoRoomToTurnAndSaysSo) {
  // An alley that it can drive into, and no more.
  ToyRobot robot({{{0.5, 0.16, 2, 0.16}, {0.5, -0.16, 2, -0.16}}, {}}, ToyFaults{});
  robot.follower.follow(route({{0, 0}, {1.2, 0}}, kPi / 2));
  const FollowOutput out =
      robot.run(30.0, [](const FollowOutput& o) { return o.state == Following::kArrived; });
  EXPECT_EQ(out.state, Following::kArrived);
  EXPECT_EQ(out.reason, "there is no room to turn");
  EXPECT_LT(robot.seconds(), 20.0);
  EXPECT_LT(off_goal_m(robot, {1.2, 0}), 0.06);
  EXPECT_GT(robot.least_gap_m, 0.005);
}

TEST(PathFollower, SaysThatItIsBlockedWhereItCanNeitherTurnNorBack) {
  const DrawnWorld box{{{-0.2, 0.16, 0.2, 0.16},
                        {-0.2, -0.16, 0.2, -0.16},
                        {0.2, -0.16, 0.2, 0.16},
                        {-0.2, -0.16, -0.2, 0.16}},
                       {}};
  ToyRobot robot(box, ToyFaults{});
  robot.follower.follow(route({{0, 0}, {-2, 0}}));
  EXPECT_EQ(robot.run_to_end(10.0).state, Following::kBlocked);
  EXPECT_GT(robot.least_gap_m, 0.005);
  EXPECT_EQ(robot.unfree_commands, 0);
}

TEST(PathFollower, NoticesThatItsWheelsSlip) {
  ToyRobot robot({}, kReal);
  robot.follower.follow(route({{0, 0}, {5, 0}}));
  robot.run_on(2.0);
  robot.slips = true;
  const double since = robot.seconds();
  FollowOutput out = robot.run_to_end(10.0);
  EXPECT_EQ(out.state, Following::kStuck);
  EXPECT_NEAR(robot.seconds() - since, 2.5, 1.0);
  EXPECT_FALSE(is_moving(robot.tick().twist)) << "until somebody decides";
  robot.slips = false;
  robot.follower.follow(route({{0, 0}, {5, 0}}));
  EXPECT_EQ(robot.run_to_end(20.0).state, Following::kArrived);
}

TEST(PathFollower, ANewRouteForTheSameErrandIsNoJerk) {
  ToyRobot robot({}, ToyFaults{});
  robot.follower.follow(route({{0, 0}, {6, 0}}));
  robot.run_on(3.0);
  robot.most_jerk_v = robot.most_jerk_w = 0.0;
  for (int i = 0; i < 40; ++i) {
    const Vector2 here = robot.pose.translation();
    const double off = i % 2 == 0 ? 0.02 : -0.02;  // as planners do
    robot.follower.follow(route({here - Vector2(0.1, 0), here + Vector2(0.5, off), {6, 0}}));
    robot.tick();
  }
  EXPECT_LT(robot.most_jerk_v, 0.1);
  EXPECT_LT(robot.most_jerk_w, 0.3);
  EXPECT_EQ(robot.run_to_end(20.0).state, Following::kArrived);
}

TEST(PathFollower, ACorrectedMapMakesItStrayIntoNothing) {
  for (const double jump : {1.0, -0.9, 0.5, -0.5}) {
    ToyRobot robot({{{-1, 0.5, 9, 0.5}, {-1, -0.5, 9, -0.5}}, {}}, kReal);
    robot.follower.follow(route({{0, 0}, {7, 0}}));
    robot.run_on(4.0);
    robot.map_T_world = {0.0, jump, 0.0};  // now the route seems to lie beyond the wall
    robot.run_on(5.0);
    EXPECT_GT(robot.least_gap_m, 0.0) << jump;
    // A moment later there is a route in the corrected map.
    robot.follower.follow(route({robot.map_T_world * robot.pose.translation(), {7, jump}}));
    EXPECT_EQ(robot.run_to_end(30.0).state, Following::kArrived) << jump;
    EXPECT_GT(robot.least_gap_m, 0.0);
    expect_sane(robot);
  }
}

/// Two legs of the route on both sides of a thin wall: never the wrong one.
TEST(PathFollower, DoesNotTakeTheLegBeyondAWall) {
  const DrawnWorld wall{{{-1, 0.3, 3, 0.3}}, {}};
  ToyRobot robot(wall, kReal, {0, 0.05, 0});
  const DriveTask task = route({{0, 0}, {3.4, 0}, {3.4, 0.6}, {0, 0.6}});
  robot.follower.follow(task);
  double before = 1e9;
  const FollowOutput out = robot.run(40.0, [&](const FollowOutput& o) {
    EXPECT_LT(before - o.remaining_m, before > 1e8 ? 1e9 : 0.6);
    before = o.remaining_m;
    return o.state == Following::kArrived;
  });
  EXPECT_EQ(out.state, Following::kArrived) << to_string(out.state) << out.reason;
  EXPECT_GT(robot.least_gap_m, 0.02);
}

TEST(PathFollower, StandsStillOnNonsenseAndSaysWhy) {
  const auto stands = [](const DriveTask& task, const Pose2& pose) {
    ToyRobot robot({}, ToyFaults{});
    robot.follower.follow(task);
    const FollowOutput out = robot.follower.next({Time(), pose, {}}, {});
    EXPECT_FALSE(is_moving(out.twist));
    EXPECT_FALSE(out.reason.empty());
    return out.state;
  };
  const DriveTask good = route({{0, 0}, {1, 0}});
  EXPECT_EQ(stands(good, {kNan, 0, 0}), Following::kWaiting);
  EXPECT_EQ(stands(good, {0, 0, kNan}), Following::kWaiting);
  EXPECT_EQ(stands(route({{0, 0}, {kNan, 0}}), {}), Following::kBlocked);
  EXPECT_EQ(stands(route({{0, 0}, {1, 0}}, kNan), {}), Following::kBlocked);
  DriveTask slow = good;
  for (const double limit : {kNan, 0.0, -1.0}) {
    slow.most_mps = limit;
    EXPECT_EQ(stands(slow, {}), Following::kBlocked) << limit;
  }
  EXPECT_EQ(stands(route({}), {}), Following::kIdle);
  EXPECT_EQ(stands(route({{5, 5}, {6, 5}}), {}), Following::kBlocked) << "it is elsewhere";
}

TEST(PathFollower, DrivesWithoutMeasuredSpeeds) {
  ToyRobot robot({}, ToyFaults{});
  robot.follower.follow(route({{0, 0}, {1, 0}}));
  const FollowOutput out = robot.follower.next({Time(), {}, {kNan, kNan}}, {});
  EXPECT_GT(out.twist.v_mps, 0.1);
  EXPECT_TRUE(is_finite(out.twist));
}

TEST(PathFollower, TakesRoutesWithPointsThatRepeat) {
  ToyRobot robot({}, ToyFaults{});
  drive(robot, route({{0, 0}, {0, 0}, {1, 0}, {1, 0}, {1, 0}, {1, 1}, {1, 1}}), 20.0);
  ToyRobot other({}, ToyFaults{});
  drive(other, route({{1, 0.2}}), 20.0);
}

TEST(PathFollower, StandsStillWithoutATaskAndAScan) {
  PathFollower follower;
  EXPECT_EQ(follower.next({}, {}).state, Following::kIdle);
  follower.follow(route({{0, 0}, {1, 0}}));
  EXPECT_EQ(follower.next({}, {}).state, Following::kWaiting) << "nothing was seen yet";
  EXPECT_FALSE(is_moving(follower.next({}, {}).twist));
  follower.follow(route({{0, 0}, {-1, 0}}));
  EXPECT_EQ(follower.next({}, {}).state, Following::kWaiting) << "nor for a turn";
  EXPECT_FALSE(is_moving(follower.next({}, {}).twist));
  follower.halt();
  EXPECT_EQ(follower.next({}, {}).state, Following::kIdle);
  EXPECT_TRUE(follower.remaining().empty());
}

TEST(PathFollower, TellsWhatIsLeft) {
  ToyRobot robot({}, ToyFaults{});
  robot.follower.follow(route({{0, 0}, {2, 0}, {2, 2}}));
  EXPECT_NEAR(robot.tick().remaining_m, 4.0, 0.01);
  EXPECT_EQ(robot.follower.remaining().size(), 3U);
  robot.run(20.0, [](const FollowOutput& o) { return o.remaining_m < 1.5; });
  const auto left = robot.follower.remaining();
  ASSERT_EQ(left.size(), 2U);
  EXPECT_NEAR((left.front() - robot.pose.translation()).norm(), 0.0, 0.1);
  EXPECT_EQ(left.back(), Vector2(2, 2));
}

TEST(FollowerConfig, ValuesThatContradictAreAProblem) {
  EXPECT_FALSE(FollowerConfig().problem());
  FollowerConfig config;
  config.least_mps = 0.9;
  EXPECT_TRUE(config.problem());
}

}  // namespace
}  // namespace dynslam
