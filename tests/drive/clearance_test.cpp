// SPDX-License-Identifier: MIT
#include "drive/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "drive/drawn_scan.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr Twist kAhead{1, 0}, kBack{-1, 0}, kLeft{0, 2}, kRight{0, -2};

ClearWay way_in(const Scan& scan, const Twist& twist) {
  Clearance clearance;
  clearance.see(scan, {});
  return clearance.way(end_of(scan), twist, {});
}
double share_in(const DrawnWorld& world, const Twist& twist) { return way_in(scan_of(world), twist).share; }

TEST(Clearance, NothingIsFreeWithoutAScan) {
  EXPECT_EQ(Clearance().way({}, kAhead, {}).share, 0.0);
  EXPECT_EQ(Clearance().way({}, {}, {}).share, 1.0) << "standing still is";
  EXPECT_EQ(Clearance().free_m({}, kLeft, {}, 0.01), 0.0);
}

TEST(Clearance, AnEmptyHallIsFree) {
  for (const Twist& t : {kAhead, kBack, kLeft, kRight, Twist{2, 1}}) EXPECT_EQ(share_in({}, t), 1.0);
}

TEST(Clearance, StopsInTimeForAWallAhead) {
  const Clearance c;
  for (const double v : {0.1, 0.3, 0.5, 1.0, 2.2}) {
    const double needs = 0.14 + 0.1 + c.stopping_distance_m(v);
    EXPECT_EQ(share_in(wall_at(needs + 0.01), {v, 0}), 1.0) << v;
    const double share = share_in(wall_at(needs - 0.02), {v, 0});
    EXPECT_LT(share, 1.0) << v;
    EXPECT_GT(share, 0.0) << v;
  }
}

/// Each beam of a lidar is off by a centimetre; that all of a hundred are not is no reason not to turn.
TEST(Clearance, NoiseDoesNotTakeTheRoomToTurn) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0.0F, 0.011F);
  for (const double away_m : {0.22, 0.23}) {
    const DrawnWorld alcove{{{-1, away_m, 1, away_m}, {away_m, -1, away_m, 1}}, {}};
    for (int i = 0; i < 20; ++i) {
      Scan scan = scan_of(alcove, {}, 1600);
      for (Beam& beam : scan.beams) beam.range_m += noise(random);
      Clearance clearance;
      clearance.see(scan, {});
      EXPECT_GT(clearance.free_m(end_of(scan), {0, 0.5}, {}, 0.01), 1.0) << away_m;
    }
  }
  Scan thin = scan_of({{}, {{0.16, 0.0, 0.005}}}, {}, 1600);
  for (Beam& beam : thin.beams) beam.range_m += noise(random);
  EXPECT_EQ(way_in(thin, kAhead).share, 0.0) << "a pencil";
  EXPECT_LT(way_in(thin, {0, 3.0}).share, 0.5);
}

TEST(Clearance, TheAllowedSpeedStopsWithinTheWay) {
  const Clearance c;
  for (double d = 0.0; d < 3; d += 0.01) EXPECT_NEAR(c.stopping_distance_m(c.safe_speed_mps(d)), d, 1e-9);
}

TEST(Clearance, FasterIsALongerZone) {
  const Clearance c;
  for (double v = 0; v < 2.2; v += 0.1) EXPECT_GT(c.stopping_distance_m(v + 0.1), c.stopping_distance_m(v));
  for (const double d : {0.3, 0.5, 0.8, 1.2}) {
    double before = 2;
    for (const double v : {0.2, 0.5, 1.0, 2.0}) {
      const double share = share_in(wall_at(d), {v, 0});
      EXPECT_LE(share, before) << d << " m, " << v << " m/s";
      before = share;
    }
  }
}

TEST(Clearance, TheAllowedSpeedDoesNotDependOnTheOneAskedFor) {
  for (const double w_share : {0.0, 0.5, 2.0}) {
    const double slow = 0.6 * share_in(wall_at(0.5), {0.6, 0.6 * w_share});
    const double fast = 2.0 * share_in(wall_at(0.5), {2.0, 2.0 * w_share});
    EXPECT_NEAR(slow, fast, 1e-6);
  }
}

TEST(Clearance, ANearerWallNeverAllowsMore) {
  for (const Twist& t : {kAhead, Twist{1, 0.5}, Twist{0.5, 2}, kLeft}) {
    double before = 0;
    for (double d = 0.16; d < 2; d += 0.02) {
      const double share = share_in(wall_at(d), t);
      EXPECT_GE(share, before - 1e-6) << d << " m";
      before = share;
    }
    EXPECT_EQ(before, 1.0);
  }
}

TEST(Clearance, IsTheSameInAMirror) {
  const DrawnWorld world{{{0.5, -0.3, 0.9, 2}, {-0.4, 0.2, -0.6, 1}}, {{0.35, -0.25, 0.05}}};
  DrawnWorld mirror = world, back = world;
  for (auto& w : mirror.walls) w = {w.x0, -w.y0, w.x1, -w.y1};
  for (auto& p : mirror.posts) p.y = -p.y;
  for (auto& w : back.walls) w = {-w.x0, w.y0, -w.x1, w.y1};
  for (auto& p : back.posts) p.x = -p.x;
  for (const Twist& t : {kAhead, kBack, kLeft, Twist{1, 1}, Twist{0.7, -1}, Twist{-1, 0.4}}) {
    const double share = share_in(world, t);
    EXPECT_NEAR(share, share_in(mirror, {t.v_mps, -t.w_radps}), 1e-4);
    EXPECT_NEAR(share, share_in(back, {-t.v_mps, -t.w_radps}), 1e-4);
  }
}

TEST(Clearance, HoldsBeforeAWallAndLeavesTheOtherWaysOpen) {
  const DrawnWorld wall = wall_at(0.14 + 0.08);
  EXPECT_EQ(share_in(wall, kAhead), 0.0);
  EXPECT_EQ(share_in(wall, {0.05, 0}), 0.0) << "however slow";
  EXPECT_EQ(share_in(wall, kBack), 1.0);
  EXPECT_GT(share_in(wall, kLeft), 0.0);
  EXPECT_NEAR(way_in(scan_of(wall), kAhead).distance_m, 0.08, 0.002);
  // Where it comes to rest by itself it can still turn away at full speed.
  EXPECT_EQ(share_in(wall_at(0.14 + 0.105), kLeft), 1.0);
}

TEST(Clearance, BesideAWallOneMayDriveAlongAndAwayButNotInto) {
  const DrawnWorld beside{{{-3, 0.2, 3, 0.2}}, {}};
  EXPECT_EQ(share_in(beside, kAhead), 1.0);
  EXPECT_EQ(share_in(beside, {1, -0.3}), 1.0);
  EXPECT_LT(share_in(beside, {1, 1}), 0.5);
}

TEST(Clearance, TurningOnTheSpotNeedsRoomForTheCorners) {
  const double corner = std::hypot(0.14, 0.12);
  const auto between = [](double half_width) {
    return DrawnWorld{{{-3, half_width, 3, half_width}, {-3, -half_width, 3, -half_width}}, {}};
  };
  EXPECT_EQ(share_in(between(corner + 0.05), kLeft), 1.0);
  const auto speed = [&](double half_width) { return 2 * corner * share_in(between(half_width), kLeft); };
  EXPECT_LT(speed(corner + 0.02), 2 * corner) << "it begins, but no faster than it can stop";
  EXPECT_GT(speed(0.14), 0.0) << "carefully";
  EXPECT_LE(speed(0.14), 0.1);
  EXPECT_EQ(speed(0.125), 0.0);
  EXPECT_GT(share_in(between(0.14), kAhead), 0.0) << "a tight corridor is left slowly";
  EXPECT_LT(share_in(between(0.14), kAhead), 0.2);
  EXPECT_GT(share_in(between(0.14), kBack), 0.0);
}

TEST(Clearance, PassesADoor) {
  const DrawnWorld door{{{0.5, 0.35, 0.5, 3}, {0.5, -0.35, 0.5, -3}}, {}};
  EXPECT_EQ(share_in(door, kAhead), 1.0);
  EXPECT_LT(share_in(door, {1, 1.5}), 1.0);
}

TEST(Clearance, SeesAThinTableLeg) {
  const DrawnWorld leg{{}, {{0.5, 0.05, 0.015}}};
  const ClearWay way = way_in(scan_of(leg), kAhead);
  EXPECT_LT(way.share, 1.0);
  EXPECT_NEAR(way.distance_m, 0.35, 0.01);
  Scan with_dropouts = scan_of(leg);
  for (std::size_t i = 0; i < with_dropouts.beams.size(); i += 2) with_dropouts.beams[i].range_m = kNan;
  EXPECT_LT(way_in(with_dropouts, kAhead).share, 1.0) << "every other beam failed";
}

TEST(Clearance, IgnoresLonePointsAndNonsense) {
  Scan scan = scan_of({});
  for (const std::size_t i : {0U, 10U, 1190U}) scan.beams[i].range_m = 0.4F;
  EXPECT_EQ(way_in(scan, kAhead).share, 1.0);
  for (const float nonsense : {kNan, kInf, -kInf, -1.0F, 0.0F, 0.05F}) {
    Scan all = scan_of({});
    for (Beam& b : all.beams) b.range_m = nonsense;
    EXPECT_EQ(way_in(all, kAhead).share, 1.0) << nonsense;
    Scan angles = scan_of(wall_at(0.4));
    for (Beam& b : angles.beams) b.angle_rad = kNan;
    EXPECT_EQ(way_in(angles, kAhead).share, 1.0);
  }
  EXPECT_EQ(way_in({}, kAhead).share, 1.0) << "no beam at all";
}

TEST(Clearance, IgnoresItsOwnBody) {
  const DrawnWorld antenna{{}, {{-0.11, 0.08, 0.02}}};
  for (const Twist& t : {kAhead, kBack, kLeft}) EXPECT_EQ(share_in(antenna, t), 1.0);
}

TEST(Clearance, KnowsWhereTheLidarSits) {
  // 10 cm ahead of the axle, looking left, head down: what is ahead of the robot appears at 90 degrees.
  Scan scan = scan_of({{}, {{0.0, 0.4, 0.1}}});
  scan.mount.robot_T_lidar = {0.1, 0, kPi / 2};
  scan.mount.upside_down = true;
  EXPECT_LT(way_in(scan, kAhead).share, 1.0);
  EXPECT_EQ(way_in(scan, kBack).share, 1.0);
  EXPECT_NEAR(way_in(scan, kAhead).distance_m, 0.1 + 0.3 - 0.14, 0.01);
}

TEST(Clearance, RemembersWhatIsTooNearToBeSeen) {
  const auto leaf_at = [](double y) { return DrawnWorld{{{-0.12, y, 0.12, y}}, {}}; };
  Clearance fresh, seen_coming;
  Time now{};
  for (const double y : {0.3, 0.26, 0.22, 0.16, 0.16, 0.16}) {
    now += milliseconds(100);
    seen_coming.see(as_a3(scan_of(leaf_at(y), now)), {});
  }
  fresh.see(as_a3(scan_of(leaf_at(0.16), now)), {});
  EXPECT_LT(seen_coming.way(now, kLeft, {}).share, 0.6) << "its corner would hit the leaf";
  EXPECT_EQ(fresh.way(now, kLeft, {}).share, 1.0) << "who never saw it cannot know";

  seen_coming.see(as_a3(scan_of(wall_at(3), now + milliseconds(100))), {});
  EXPECT_LT(seen_coming.way(now + milliseconds(100), kRight, {}).share, 0.6)
      << "nothing comes back from there: it may still be there";
  const DrawnWorld room{{{-3, -3, -3, 3}, {3, -3, 3, 3}, {-3, 3, 3, 3}, {-3, -3, 3, -3}}, {}};
  seen_coming.see(as_a3(scan_of(room, now + milliseconds(200))), {});
  EXPECT_EQ(seen_coming.way(now + milliseconds(200), kLeft, {}).share, 1.0) << "one sees where it was";
}

TEST(Clearance, ARangeOfZeroIsNoTroubleWhereNearReturnsCount) {
  ClearanceConfig config;
  config.min_range_m = 0.0;
  Scan scan = scan_of(wall_at(3), {}, 1200);
  for (std::size_t i = 0; i < 4; ++i) scan.beams[i].range_m = 0.0F;
  Clearance clearance({}, config);
  clearance.see(scan, {});
  EXPECT_EQ(clearance.way(end_of(scan), kLeft, {}).share, 1.0) << "it is inside of the robot";
}

/// By its noise what is at 24 cm seems to be nearer at times; it is seen still, and not hidden.
TEST(Clearance, RemembersNothingInsteadOfWhatItSees) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0.0F, 0.011F);
  Clearance clearance;
  for (int i = 0; i < 50; ++i) {
    Scan scan = scan_of(DrawnWorld{{{-1, 0.24, 1, 0.24}, {0.24, -1, 0.24, 1}}, {}},
                        Time(milliseconds(100 * i)), 1200);
    for (Beam& beam : scan.beams) beam.range_m += noise(random);
    clearance.see(scan, {});
    EXPECT_GT(clearance.free_m(end_of(scan), {0, 0.5}, {}, 0.01), 1.0) << i;
  }
}

/// The end of a board, part of it just near enough to be seen: the rest is hidden, not gone.
TEST(Clearance, RemembersTheHiddenPartOfWhatItSeesInPart) {
  Clearance clearance;
  RecentMotion motion;
  const DrawnWorld board{{{0.15, 0.1, 0.15, 0.16}}, {}};  // at 0.18 to 0.22 m
  for (int i = 0; i < 5; ++i) {
    const Scan scan = scan_of(board, Time(milliseconds(100 * i)), 1200);
    clearance.see(i < 2 ? scan : as_a3(scan), motion);
  }
  EXPECT_LT(clearance.free_m(Time(milliseconds(400)), kRight, motion, 0.01), 0.2);
}

/// A table's leg beside the robot's corner: that one sees past it on either side says nothing of the leg.
TEST(Clearance, RemembersAThinThingThatItSeesPast) {
  const auto at = [](double angle_deg) -> Vector2 {
    return 0.18 * Vector2(std::cos(angle_deg * kPi / 180.0), std::sin(angle_deg * kPi / 180.0));
  };
  const Vector2 a = at(129.0), b = at(135.0);
  const std::vector<DrawnWorld::Wall> room{{-3, -3, -3, 3}, {3, -3, 3, 3}, {-3, 3, 3, 3}, {-3, -3, 3, -3}};
  DrawnWorld with_leg{room, {}};
  with_leg.walls.push_back({a.x(), a.y(), b.x(), b.y()});
  Clearance clearance;
  for (int i = 0; i < 10; ++i) {
    const Scan scan = scan_of(with_leg, Time(milliseconds(100 * i)), 1200);
    clearance.see(i < 4 ? scan : as_a3(scan), {});
  }
  EXPECT_LT(clearance.way(Time(milliseconds(900)), kRight, {}).share, 0.6);
  clearance.see(as_a3(scan_of({room, {}}, Time(milliseconds(1000)), 1200)), {});
  EXPECT_EQ(clearance.way(Time(milliseconds(1000)), kRight, {}).share, 1.0) << "it was taken away";
}

TEST(Clearance, WhatIsTooNearStaysBehindAsTheRobotDrivesOn) {
  RecentMotion motion;
  Clearance clearance;
  const DrawnWorld world{{{-0.1, 0.16, 0.1, 0.16}}, {}};
  Time now{};
  clearance.see(scan_of(world, now), motion);  // all of it is seen, for once
  for (int i = 0; i < 6; ++i) {
    for (int tick = 0; tick < 5; ++tick) motion.add(now + milliseconds(20 * tick), {1.0, 0.0}, {});
    now += milliseconds(100);
    clearance.see(as_a3(scan_of({}, now)), motion);
    if (i == 0) {
      EXPECT_LT(clearance.way(now, kRight, motion).share, 0.5);
    }
  }
  EXPECT_EQ(clearance.way(now, kRight, motion).share, 1.0);
}

TEST(Clearance, CarriesAnOldScanAlong) {
  const Scan scan = scan_of(wall_at(0.8));
  RecentMotion motion;
  motion.add(scan.stamp, kAhead, {});
  Clearance c;
  c.see(scan, motion);
  const double fresh = c.way(scan.stamp, kAhead, motion).share;
  const ClearWay old = c.way(scan.stamp + milliseconds(200), kAhead, motion);
  EXPECT_LT(old.share, fresh);
  EXPECT_NEAR(old.share, share_in(wall_at(0.6), kAhead), 1e-6);
  EXPECT_NEAR(old.distance_m, 0.6 - 0.14, 0.002);
  EXPECT_NEAR(c.way(scan.stamp + milliseconds(200), {-0.3, 0}, motion).share, 1.0, 1e-9);
}

/// It was told to back off for 200 ms: it may not have begun.
TEST(Clearance, DoesNotCountOnAMotionThatMayNotHaveBegun) {
  const Scan scan = scan_of(wall_at(0.5));
  RecentMotion motion;
  motion.add(scan.stamp, {-1, 0}, {});
  Clearance c;
  c.see(scan, motion);
  EXPECT_NEAR(c.way(scan.stamp + milliseconds(200), kAhead, motion).share, share_in(wall_at(0.5), kAhead),
              1e-6);
}

/// While it turned by 90 degrees in a scan of 0.1 s, each beam saw the world from another heading.
TEST(Clearance, TakesEachBeamAtItsOwnTime) {
  const double turn_radps = kPi / 2 / 0.1;
  const DrawnWorld post{{}, {{0.0, 1.0, 0.05}}};  // to the left at first, ahead at the end
  RecentMotion motion;
  motion.add(Time(), {0, turn_radps}, {});
  Scan scan;
  for (std::size_t i = 0; i < 1200; ++i) {
    const double t = 0.1 * static_cast<double>(i) / 1200.0, angle = kTwoPi * static_cast<double>(i) / 1200.0;
    const Pose2 at{0, 0, turn_radps * t};
    scan.beams.push_back(
        {static_cast<float>(angle), static_cast<float>(cast(post, at, angle)), static_cast<float>(t)});
  }
  Clearance c;
  c.see(scan, motion);
  const ClearWay way = c.way(end_of(scan), {2, 0}, motion);
  EXPECT_NEAR(way.share, share_in({{}, {{1.0, 0.0, 0.05}}}, {2, 0}), 0.01);
  EXPECT_NEAR(way.distance_m, 0.81, 0.01);
}

/// A robot that obeys: whatever speed it has, it never comes nearer to the wall than its margin.
TEST(Clearance, ARobotThatObeysNeverTouchesTheWall) {
  for (const double wanted : {0.2, 0.7, 1.5, 2.2}) {
    double x = 0, v = 0;  // the wall is at 4 m
    Clearance c;
    RecentMotion motion;
    Scan scan;
    for (int ms = 0; ms < 20000; ms += 20) {
      const Time now = Time(milliseconds(ms));
      if (ms % 100 == 0) c.see(scan = scan_of(wall_at(4 - x), now, 400), motion);
      const Twist twist{std::min(wanted, v + 0.02), 0};
      const double commanded = twist.v_mps * c.way(now, twist, motion).share;
      motion.add(now, {commanded, 0}, {});
      // The wheels follow late: a lag of 0.15 s, and brakes of 1.5 m/s2.
      v = std::max(v + 0.02 / 0.15 * (commanded - v), v - 0.03);
      x += 0.02 * v;
    }
    EXPECT_LT(x, 4 - 0.14 - 0.05) << wanted;
    EXPECT_GT(x, 4 - 0.14 - 0.16) << wanted << ": and it does come near";
  }
}

TEST(ClearanceConfig, MarginsThatContradictAreAProblem) {
  EXPECT_FALSE(ClearanceConfig().problem());
  ClearanceConfig config;
  config.side_margin_m = 0.2;
  EXPECT_TRUE(config.problem());
}

}  // namespace
}  // namespace dynslam
