// SPDX-License-Identifier: MIT
#include "slam/slam.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "slam/drawn_world.h"
#include "support_matchers.h"

namespace dynslam {
namespace {

/// A robot that drives a loop through both rooms, with whatever sensors a test gives it.
class Drive {
 public:
  explicit Drive(const SlamConfig& config = {}) : slam(config) {}

  /// Out of the left room, round the right one and back, in about a minute; starts standing at (2, 2.45).
  static Pose2 world_T_robot(Time t) {
    const double s = std::max(0.0, seconds_of(t) - 1.0);
    const double phase = 0.1 * s;  // 63 s a round
    return {4.2 - 2.2 * std::cos(phase), 2.45 + 0.5 * std::sin(2 * phase) * std::sin(phase),
            0.8 * std::sin(1.3 * phase)};
  }

  static Pose2 start() { return world_T_robot(time_at_s(0)); }

  void scan(double t_s, const LidarMount& mount = {}) {
    slam.add(look(world, time_at_s(t_s), world_T_robot, lidar, random, mount));
  }
  void imu_until(double t_s) {
    for (; imu_s_ <= t_s; imu_s_ += 0.01) {
      const double yaw = world_T_robot(time_at_s(imu_s_)).yaw + 1.0 + imu_drift_radps * imu_s_;
      slam.add(
          ImuSample{time_at_s(imu_s_), Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))});
    }
  }
  void odometry(double t_s, const Pose2& odom_T_start = {5, 5, 1}) {
    slam.add(
        OdometrySample{time_at_s(t_s), odom_T_start * start().inverse() * world_T_robot(time_at_s(t_s))});
  }

  /// How far a result is off the truth: the map's frame is the robot's at the first scan.
  static Pose2 error(const ScanResult& r, const Pose2& first) {
    return (first.inverse() * world_T_robot(r.stamp)).inverse() * r.map_T_robot;
  }
  /// Works off what is ready; the worst distance off the truth so far.
  double worst(bool at_end = false) {
    while (auto r = slam.next(at_end)) {
      results.push_back(*r);
      if (results.size() == 1) first_ = world_T_robot(r->stamp) * r->map_T_robot.inverse();
      const Pose2 off = error(*r, first_);
      worst_m = std::max(worst_m, off.translation().norm());
      worst_rad = std::max(worst_rad, std::abs(off.yaw));
    }
    return worst_m;
  }

  DrawnWorld world = two_rooms();
  DrawnLidar lidar{.beams = 400, .turn_s = 0.08, .noise_m = 0.01};
  std::mt19937 random{5};
  double imu_drift_radps = 0.0;
  Slam slam;
  std::vector<ScanResult> results;
  double worst_m = 0.0, worst_rad = 0.0;

 private:
  double imu_s_ = 0.0;
  Pose2 first_;
};

TEST(Slam, FollowsARobotByLidarAlone) {
  Drive drive({.close_loops = false});
  for (int i = 0; i < 300; ++i) {
    drive.scan(0.1 * i);
    drive.worst();
  }
  drive.worst(true);
  EXPECT_EQ(drive.results.size(), 300U);
  EXPECT_LT(drive.worst_m, 0.03);
  EXPECT_LT(drive.worst_rad, 0.02);
  EXPECT_GT(drive.slam.local_maps_begun(), 3U);
  EXPECT_LE(drive.slam.local_maps_active(), 2U);
}

TEST(Slam, FollowsARobotWithAnImuThatDrifts) {
  Drive drive;
  drive.imu_drift_radps = 0.01;
  for (int i = 0; i < 300; ++i) {
    drive.imu_until(0.1 * i + 0.05);
    drive.scan(0.1 * i);
    drive.worst();
  }
  drive.worst(true);
  EXPECT_LT(drive.worst_m, 0.03);
  EXPECT_LT(drive.worst_rad, 0.02) << "the map has the last word on yaw, not 0.3 rad of drift";
}

TEST(Slam, TakesSparseScansWithWheelOdometry) {
  SlamConfig config;
  Drive drive(config);
  drive.lidar.turn_s = 0.0;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 10; ++k) drive.odometry(1.0 * i + 0.1 * k);
    drive.scan(1.0 * i);
    drive.worst();
  }
  drive.worst(true);
  EXPECT_LT(drive.worst_m, 0.05);
}

TEST(Slam, SetsWheelsAsideThatFreezeAndThenLeap) {
  Drive drive;
  drive.lidar.turn_s = 0.0;
  const Pose2 odom_T_start{5, 5, 1};
  const auto way = [](double t_s) { return Drive::start().inverse() * Drive::world_T_robot(time_at_s(t_s)); };
  for (int i = 0; i < 200; ++i) {
    const double t = 0.1 * i;
    Pose2 odom_T_robot = odom_T_start * way(t);
    if (i >= 100 && i <= 110) odom_T_robot = odom_T_start * way(10.0);  // frozen; then 85 degrees at once
    if (i > 110) odom_T_robot = odom_T_start * way(11.0) * Pose2{0, 0, 1.5} * way(11.0).inverse() * way(t);
    drive.slam.add(OdometrySample{time_at_s(t), odom_T_robot});
    drive.scan(t);
    drive.worst();
  }
  drive.worst(true);
  EXPECT_LT(drive.worst_m, 0.05);
  EXPECT_GT(drive.slam.counters()["slam.priors_set_aside"], 0U);
}

TEST(Slam, LooksAboutWhenTheYawOfTheWheelsLagsForAScan) {
  Drive drive;
  drive.lidar.turn_s = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.1 * i;
    const Pose2 lag{0, 0, i >= 60 && i % 20 == 0 ? radians(-10) : 0.0};
    const Pose2 way = Drive::start().inverse() * Drive::world_T_robot(time_at_s(t));
    drive.slam.add(OdometrySample{time_at_s(t), Pose2{5, 5, 1} * way * lag});
    drive.scan(t);
    drive.worst();
  }
  drive.worst(true);
  EXPECT_LT(drive.worst_m, 0.03);
  EXPECT_LT(drive.worst_rad, 0.02) << "no scan is drawn askew";
  EXPECT_GT(drive.slam.counters()["slam.priors_set_aside"], 0U);
}

/// Where a drive of 3.5 m along a bare corridor ends, with wheels that stand still for 0.8 s on the way, or
/// do not, and then make up for it.
Pose2 end_of_corridor(bool wheels_stand_still) {
  DrawnWorld corridor;
  corridor.walls.push_back({{-40, -0.993}, {60, -0.993}});
  corridor.walls.push_back({{-40, 1.107}, {60, 1.107}});
  const auto world_T_robot = [](Time t) {
    return Pose2{0.5 * seconds_of(t), 0, 0.05 * std::sin(1.3 * seconds_of(t))};
  };
  Slam slam(SlamConfig{});
  std::mt19937 random(9);
  Pose2 last;
  for (int i = 0; i <= 70; ++i) {
    const int counted = wheels_stand_still && i > 40 && i < 49 ? 40 : i;
    slam.add(OdometrySample{time_at_s(0.1 * i), Pose2{7, -3, 1} * world_T_robot(time_at_s(0.1 * counted))});
    slam.add(look(corridor, time_at_s(0.1 * i), world_T_robot, {.turn_s = 0, .noise_m = 0.003}, random));
    while (const auto r = slam.next(i == 70)) last = r->map_T_robot;
  }
  EXPECT_EQ(slam.counters()["slam.wheels_leapt"] > 0, wheels_stand_still);
  EXPECT_NEAR(last.x, 3.5, 0.04);
  return last;
}

/// Beams at the same angles leave dots at the same distances ahead: matched dot on dot, the robot would never
/// move.
TEST(Slam, FollowsTheWheelsWhereACorridorSaysNothing) {
  DrawnWorld corridor;
  corridor.walls.push_back({{-40, -0.993}, {60, -0.993}});
  corridor.walls.push_back({{-40, 1.107}, {60, 1.107}});
  const auto world_T_robot = [](Time t) { return Pose2{0.5 * seconds_of(t), 0, 0}; };
  Slam slam({});
  std::mt19937 random(4);
  Pose2 last;
  for (int i = 0; i <= 100; ++i) {
    const Time t = time_at_s(0.1 * i);
    slam.add(OdometrySample{t, world_T_robot(t)});
    slam.add(look(corridor, t, world_T_robot, {.turn_s = 0, .noise_m = 0.003}, random));
    while (const auto r = slam.next(true)) last = r->map_T_robot;
  }
  EXPECT_THAT(last, PoseNear(Pose2{5, 0, 0}, 0.05, 0.005));
}

TEST(Slam, WheelsThatStandStillAndCatchUpInABareCorridorChangeNothing) {
  EXPECT_THAT(end_of_corridor(true), PoseNear(end_of_corridor(false), 0.05, 0.005));
}

TEST(Slam, SurvivesASecondWithoutScans) {
  Drive drive;
  for (int i = 0; i < 150; ++i) {
    drive.imu_until(0.1 * i + 0.05);
    if (i < 80 || i > 90) drive.scan(0.1 * i);
    drive.worst();
  }
  drive.worst(true);
  EXPECT_LT(drive.worst_m, 0.04);
}

TEST(Slam, PutsLidarsThatSitAnyhowWhereTheyBelong) {
  for (const LidarMount& mount :
       {LidarMount{{0.12, -0.03, 1.1}, false}, LidarMount{{-0.05, 0.02, -2.9}, true}}) {
    Drive drive;
    for (int i = 0; i < 120; ++i) {
      drive.scan(0.1 * i, mount);
      drive.worst();
    }
    drive.worst(true);
    EXPECT_LT(drive.worst_m, 0.03);
  }
}

TEST(Slam, DrawsAMapThatAgreesWithTheWorld) {
  for (const bool close_loops : {false, true}) {
    Drive drive({.close_loops = close_loops});
    for (int i = 0; i < 100; ++i) drive.scan(0.1 * i);
    drive.worst(true);
    drive.slam.finish();
    const Pose2 map_T_world = Drive::start().inverse();
    const GridSnapshot map = drive.slam.global_map().snapshot();
    const auto state_at = [&](double x, double y) {
      return map.state(cell_at(map_T_world * Vector2(x, y), map.cell_size_m()));
    };
    EXPECT_EQ(state_at(2.5, 2.5), CellState::kFree);
    EXPECT_EQ(state_at(3.8, 2.0), CellState::kFree);
    bool wall = false;
    for (double x = 4.46; x <= 4.54; x += 0.01) wall = wall || state_at(x, 1.0) == CellState::kOccupied;
    EXPECT_TRUE(wall) << "between the rooms";
    EXPECT_EQ(state_at(1.45, 4.0), CellState::kUnknown) << "the inside of the cupboard";
    EXPECT_EQ(state_at(-0.5, 2.0), CellState::kUnknown) << "behind the outer wall";
  }
}

TEST(Slam, GivesTheSameResultsForTheSameSamples) {
  const auto run = [] {
    Drive drive;
    for (int i = 0; i < 80; ++i) drive.scan(0.1 * i);
    drive.worst(true);
    return drive.results;
  };
  const auto a = run(), b = run();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].map_T_robot, b[i].map_T_robot);
}

TEST(Slam, BeginsNoLocalMapWhileTheRobotStands) {
  Drive drive;
  const Scan scan = look(
      drive.world, {},
      [](Time) {
        return Pose2{2, 2, 0};
      },
      drive.lidar, drive.random);
  for (int i = 0; i < 200; ++i) {
    Scan again = scan;
    again.stamp = time_at_s(0.1 * i);
    drive.slam.add(again);
  }
  int inserted = 0;
  while (auto r = drive.slam.next(true)) inserted += r->inserted ? 1 : 0;
  EXPECT_EQ(inserted, 200);
  EXPECT_EQ(drive.slam.local_maps_begun(), 1U);
}

TEST(Slam, WaitsForTheImuButNotForEver) {
  Drive drive;
  drive.imu_until(0.5);
  drive.scan(0.48);  // lasts until 0.56
  EXPECT_FALSE(drive.slam.next());
  EXPECT_EQ(drive.slam.waiting(), 1U);
  drive.imu_until(0.561);
  EXPECT_FALSE(drive.slam.next()) << "the newest sample may be a spike";
  drive.imu_until(0.575);
  EXPECT_TRUE(drive.slam.next());
  drive.scan(0.58);  // and now the IMU falls silent
  drive.scan(0.68);
  EXPECT_FALSE(drive.slam.next());
  drive.scan(0.88);
  EXPECT_TRUE(drive.slam.next());
  EXPECT_FALSE(drive.slam.next());
  EXPECT_TRUE(drive.slam.next(true));
}

TEST(Slam, WaitsForItsWheelsButNotForThoseThatAreLongSilent) {
  Drive drive;
  const auto wheels = [&](double t_s) { drive.slam.add(OdometrySample{time_at_s(t_s), {}}); };
  wheels(0.5);
  drive.scan(0.48);  // lasts until 0.56
  EXPECT_FALSE(drive.slam.next());
  wheels(0.56);
  EXPECT_TRUE(drive.slam.next());
  drive.scan(0.58);  // and now they fall silent
  EXPECT_FALSE(drive.slam.next());
  drive.scan(0.88);
  EXPECT_TRUE(drive.slam.next());
  EXPECT_TRUE(drive.slam.next(true));
  drive.scan(1.98);
  EXPECT_TRUE(drive.slam.next()) << "nor are they waited for again";
}

TEST(Slam, PassesOverScansOutOfOrderAndFollowsAClockSetBack) {
  Drive drive;
  drive.scan(10.0);
  drive.scan(10.0);
  drive.scan(9.95);
  drive.scan(10.1);
  drive.scan(2.0);
  drive.scan(2.1);
  drive.worst(true);
  EXPECT_EQ(drive.results.size(), 4U);
  EXPECT_EQ(drive.slam.counters()["slam.scans_out_of_order"], 2U);
  EXPECT_EQ(drive.slam.counters()["slam.clock_jumps"], 1U);
}

TEST(Slam, LivesThroughEmptyBlindAndHugeScans) {
  Drive drive;
  Scan empty, blind, huge;
  empty.stamp = time_at_s(0.1);
  blind.stamp = time_at_s(0.2);
  huge.stamp = time_at_s(0.3);
  for (int i = 0; i < 100; ++i)
    blind.beams.push_back({0.01F * static_cast<float>(i), i % 2 ? INFINITY : NAN, 0});
  for (int i = 0; i < 1000000; ++i) huge.beams.push_back({static_cast<float>(i * kTwoPi / 1e6), 3.0F, 0});
  for (const Scan& s : {empty, blind, huge}) drive.slam.add(s);
  drive.scan(0.4);
  drive.worst(true);
  ASSERT_EQ(drive.results.size(), 4U);
  EXPECT_FALSE(drive.results[0].inserted);
  EXPECT_FALSE(drive.results[1].inserted);
  EXPECT_TRUE(drive.results[2].inserted);
}

TEST(Slam, SaysThatAScanDoesNotMatchAndStartsAnewWhenNoneDoes) {
  Drive drive;
  for (int i = 0; i < 30; ++i) drive.scan(0.1 * i);
  drive.worst(true);
  DrawnWorld elsewhere;
  elsewhere.add_box(-0.4, -0.5, 0.45, 0.4);
  for (int i = 30; i < 80; ++i) {
    drive.slam.add(look(
        elsewhere, time_at_s(0.1 * i), [](Time) { return Pose2{}; }, drive.lidar, drive.random));
  }
  int unmatched = 0, matched_after = 0;
  while (auto r = drive.slam.next(true)) {
    unmatched += r->matched ? 0 : 1;
    matched_after += unmatched > 0 && r->matched ? 1 : 0;
  }
  EXPECT_GE(unmatched, 20);
  EXPECT_GT(matched_after, 20);
  EXPECT_EQ(drive.slam.counters()["slam.times_lost"], 1U);
}

TEST(Slam, StartsAnewOnAMapOfOneLookAfterOneOfMany) {
  Drive drive;
  for (int i = 0; i < 60; ++i) drive.scan(0.1 * i);
  DrawnWorld elsewhere;
  elsewhere.add_box(-0.4, -0.5, 0.45, 0.4);
  for (int i = 60; i < 160; ++i) {
    drive.slam.add(look(
        elsewhere, time_at_s(0.1 * i), [](Time) { return Pose2{}; }, drive.lidar, drive.random));
  }
  while (drive.slam.next(true)) continue;
  EXPECT_EQ(drive.slam.counters()["slam.times_lost"], 1U);
  EXPECT_EQ(drive.slam.counters()["slam.scans_unmatched"], 21U)
      << "the new map is used from its first look on";
}

TEST(Slam, KeepsItsMapWhileTheLidarIsCovered) {
  Drive drive;
  for (int i = 0; i < 100; ++i) {
    if (i < 30 || i >= 70) {
      drive.scan(i < 30 ? 0.1 * i : 0.1 * (i - 41));  // the robot waits meanwhile
      continue;
    }
    Scan blind;
    blind.stamp = time_at_s(2.9 + 0.0001 * (i - 29));
    for (int k = 0; k < 400; ++k) blind.beams.push_back({0.01F * static_cast<float>(k), INFINITY, 0});
    drive.slam.add(blind);
  }
  drive.worst(true);
  EXPECT_EQ(drive.slam.counters()["slam.times_lost"], 0U);
  EXPECT_LT(drive.worst_m, 0.05);
}

TEST(Slam, DropsOdometryThatIsNonsense) {
  Drive drive;
  drive.lidar.turn_s = 0;
  for (int i = 0; i < 40; ++i) {
    drive.odometry(0.1 * i, i == 20 ? Pose2{1e8, 0, 0} : i == 25 ? Pose2{NAN, 0, 0} : Pose2{5, 5, 1});
    drive.scan(0.1 * i);
  }
  drive.worst(true);
  EXPECT_EQ(drive.slam.counters()["odometry.nonsense"], 2U);
  EXPECT_LT(drive.worst_m, 0.05);
}

TEST(Slam, OutlivesALeapInTimeAndPlaceTogether) {
  Drive drive;
  drive.lidar.turn_s = 0;
  for (int i = 0; i < 20; ++i) {
    const double t = i < 10 ? 0.1 * i : 1.7e9 + 0.1 * i;
    drive.slam.add(OdometrySample{time_at_s(t), Pose2{i < 10 ? 0.0 : 3e6, 0, 0}});
    Scan scan = look(drive.world, time_at_s(0.1 * i), Drive::world_T_robot, drive.lidar, drive.random);
    scan.stamp = time_at_s(t);
    drive.slam.add(scan);
  }
  int seen = 0;
  while (const auto r = drive.slam.next(true)) {
    EXPECT_LT(r->map_T_robot.translation().norm(), 100.0);
    ++seen;
  }
  EXPECT_EQ(seen, 20);
}

TEST(Slam, ClosesLoopsWhenAsked) {
  SlamConfig config;
  config.close_loops = true;
  config.scans_per_local_map = 20;
  Drive drive(config);
  for (int i = 0; i < 700; ++i) {  // once round, and a little more
    drive.scan(0.1 * i);
    drive.worst();
  }
  drive.worst(true);
  drive.slam.finish();
  EXPECT_GT(drive.slam.back_end().loops().closures(), 3U);
  EXPECT_LT(drive.worst_m, 0.05);
  const auto trajectory = drive.slam.trajectory();
  ASSERT_EQ(trajectory.size(), 700U);
  const Pose2 map_T_world =
      trajectory.front().map_T_robot * Drive::world_T_robot(trajectory.front().stamp).inverse();
  double worst = 0;
  for (const StampedFix& f : trajectory) {
    worst = std::max(
        worst,
        (f.map_T_robot.translation() - (map_T_world * Drive::world_T_robot(f.stamp)).translation()).norm());
  }
  EXPECT_LT(worst, 0.03);
  const GridSnapshot map = drive.slam.global_map().snapshot();
  const auto state_at = [&](double x, double y) {
    return map.state(cell_at(map_T_world * Vector2(x, y), map.cell_size_m()));
  };
  EXPECT_EQ(state_at(2.5, 2.5), CellState::kFree);
  EXPECT_EQ(state_at(1.45, 4.0), CellState::kUnknown) << "the inside of the cupboard";
  int wall = 0;
  for (double y = 0.3; y < 1.9; y += 0.02) {
    int across = 0;
    for (double x = 4.4; x <= 4.6; x += 0.02) across += state_at(x, y) == CellState::kOccupied ? 1 : 0;
    wall += across >= 1 && across <= 3 ? 1 : 0;
  }
  EXPECT_GT(wall, 65) << "of 80 places, the wall between the rooms is there and thin";
}

TEST(Slam, KeepsOfThePathNoMoreThanItIsAskedTo) {
  SlamConfig config;
  config.scans_per_local_map = 10;
  Drive all(config), last(config);
  last.slam.keep_path(100);
  for (Drive* drive : {&all, &last}) {
    for (int i = 0; i < 700; ++i) {
      drive->scan(0.1 * i);
      drive->worst();
    }
    drive->worst(true);
    drive->slam.finish();
  }
  const auto whole = all.slam.trajectory(), kept = last.slam.trajectory();
  ASSERT_EQ(whole.size(), 700U);
  ASSERT_EQ(kept.size(), 100U);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(kept[i].stamp, whole[600 + i].stamp);
    EXPECT_EQ(kept[i].map_T_robot, whole[600 + i].map_T_robot);
  }
  EXPECT_GT(all.slam.back_end().retired().size(), last.slam.back_end().retired().size() + 5);
  for (const RefusedLoop& r : last.slam.back_end().loops().refused())
    EXPECT_NO_THROW(last.slam.back_end().map_T_origin(r.a)) << r.a << ' ' << r.b;
  last.slam.keep_path(0);
  EXPECT_EQ(last.slam.trajectory().size(), 1U);
}

TEST(Slam, SkipsScansTakenInAFastTurn) {
  SlamConfig config;
  config.skip_yaw_rate_radps = 2.0;
  Slam slam(config);
  std::mt19937 random(1);
  const auto turning = [](Time t) { return Pose2{2, 2, 3.0 * seconds_of(t)}; };
  for (int i = 0; i < 100; ++i) {
    const double yaw = 0.03 * i;
    slam.add(
        ImuSample{time_at_s(0.01 * i), Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))});
  }
  for (int i = 1; i < 8; ++i)
    slam.add(look(two_rooms(), time_at_s(0.1 * i), turning, {.beams = 400}, random));
  int inserted = 0, seen = 0;
  while (auto r = slam.next(true)) {
    inserted += r->inserted ? 1 : 0, ++seen;
    EXPECT_EQ(r->unsteady, Unsteady::kTurning);
  }
  EXPECT_EQ(seen, 7);
  EXPECT_EQ(inserted, 0);
  EXPECT_EQ(slam.counters()["slam.scans_skipped_turning"], 7U);
}

TEST(Slam, StaysWithinItsChunks) {
  SlamConfig config;
  config.max_chunks = 64;
  config.cell_size_m = 0.005;
  config.close_loops = false;
  Drive drive(config);
  for (int i = 0; i < 10; ++i) drive.scan(0.1 * i);
  drive.worst(true);
  EXPECT_EQ(drive.slam.global_map().chunk_count(), 64U);
  EXPECT_GT(drive.slam.counters()["map.cells_refused"], 0U);
}

TEST(Slam, RefusesRaysOfTooManyCells) {
  SlamConfig config;
  config.cell_size_m = 0.005;
  config.trusted_range_m = 50;
  EXPECT_THROW(Slam{config}, InputError);
}

/// Notes what the stages are called.
struct Names : StageWatch {
  std::vector<std::string> names;
  void enter(std::string_view stage) override { names.emplace_back(stage); }
};

TEST(Slam, TellsItsStages) {
  Names names;
  Slam slam({.close_loops = false}, &names);
  std::mt19937 random(1);
  slam.add(look(
      two_rooms(), {},
      [](Time) {
        return Pose2{2, 2, 0};
      },
      {}, random));
  ASSERT_TRUE(slam.next(true));
  EXPECT_EQ(names.names, (std::vector<std::string>{"passes", "match", "insert", "draw", ""}));
}

}  // namespace
}  // namespace dynslam
