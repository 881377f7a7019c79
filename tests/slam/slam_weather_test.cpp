// SPDX-License-Identifier: MIT
// Sensors that fail, lie or stop talking, through the whole of Slam.

#include <algorithm>
#include <optional>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "slam/drawn_drive.h"

namespace dynslam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Out of the left room, about the right one and back, in 40 s.
Route through_the_flat(const Pose2& start = {2.0, 2.45, 0}) {
  Route way(start);
  way.stand(1.0).go_to(5.3, 2.45).go_to(6.3, 3.2).go_to(7.2, 1.9).go_to(5.2, 2.3);
  return way.go_to(2.5, 2.45).go_to(1.2, 1.4).go_to(2.0, 2.45);
}

/// That way, driven to its end once the weather is made.
class FlatDrive : public DrawnDrive {
 public:
  FlatDrive() : DrawnDrive(two_rooms(), through_the_flat()) {}
  void run() {
    until(through_the_flat().end_s());
    finish();
  }
};

constexpr double kFails_s = 6.0;  ///< sensors that fail on the way do it here

// ---- the IMU ----

ImuSample turned_to(ImuSample sample, double yaw) {
  sample.world_q_robot = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  return sample;
}

FlatDrive drive_with_mirrored_imu() {
  FlatDrive drive;
  drive.imu = [](const ImuSample& s) { return std::vector{turned_to(s, -yaw_of(s.world_q_robot))}; };
  drive.run();
  return drive;
}

TEST(SlamWeather, NothingIsFoundWhereNothingIsWrong) {
  FlatDrive drive;
  drive.imu = drive.fair<ImuSample>;
  drive.wheels = drive.fair<OdometrySample>;
  drive.run();
  EXPECT_THAT(drive.slam.findings(), IsEmpty());
  EXPECT_LT(drive.worst_m(), 0.03);
  EXPECT_EQ(drive.map().share_off(drive.world, 0.05), 0.0);
}

TEST(SlamWeather, AMirroredImuIsNamed) {
  EXPECT_THAT(drive_with_mirrored_imu().slam.findings(),
              ElementsAre(HasSubstr("the IMU turns the other way")));
}

TEST(SlamWeather, AMirroredImuDoesNotBendTheMap) {
  FlatDrive drive = drive_with_mirrored_imu();
  EXPECT_EQ(drive.map().share_off(drive.world, 0.05), 0.0);
  EXPECT_LT(drive.worst_m(), 0.05);
}

/// Poses without help from an IMU that fails.
double worst_with(const DrawnDrive::Weather<ImuSample>& imu) {
  FlatDrive drive;
  drive.imu = imu;
  drive.run();
  EXPECT_EQ(drive.slam.counters()["slam.times_lost"], 0U);
  return drive.worst_m();
}

TEST(SlamWeather, NoImuIsNeeded) { EXPECT_LT(worst_with(nullptr), 0.05); }

TEST(SlamWeather, AnImuMayFallSilent) {
  const double worst = worst_with([](const ImuSample& s) {
    return seconds_of(s.stamp) > kFails_s ? std::vector<ImuSample>{} : std::vector{s};
  });
  EXPECT_LT(worst, 0.05);
}

TEST(SlamWeather, AnImuMayRepeatItsLastSample) {
  const double worst = worst_with([](ImuSample s) {
    s.stamp = std::min(s.stamp, time_at_s(kFails_s));
    return std::vector{s};
  });
  EXPECT_LT(worst, 0.05);
}

TEST(SlamWeather, AnImuMayFreeze) {
  const double worst = worst_with(
      [](const ImuSample& s) { return std::vector{seconds_of(s.stamp) > kFails_s ? turned_to(s, 0.7) : s}; });
  EXPECT_LT(worst, 0.05);
}

TEST(SlamWeather, AnImuMayBeFrozenFromTheStart) {
  EXPECT_LT(worst_with([](const ImuSample& s) { return std::vector{turned_to(s, 0.7)}; }), 0.05);
}

TEST(SlamWeather, AnImuMaySendZeroQuaternions) {
  for (const double from_s : {0.0, kFails_s}) {
    const double worst = worst_with([from_s](ImuSample s) {
      if (seconds_of(s.stamp) >= from_s) s.world_q_robot.coeffs().setZero();
      return std::vector{s};
    });
    EXPECT_LT(worst, 0.05) << from_s;
  }
}

TEST(SlamWeather, AnImuMaySendNoNumbers) {
  for (const double to_s : {kFails_s + 0.015, 1e9}) {
    const double worst = worst_with([to_s](ImuSample s) {
      if (seconds_of(s.stamp) > kFails_s && seconds_of(s.stamp) < to_s)
        s.world_q_robot.coeffs().setConstant(NAN);
      return std::vector{s};
    });
    EXPECT_LT(worst, 0.05) << to_s;
  }
}

// ---- the wheels ----

TEST(SlamWeather, ALidarThatSitsBackwardsIsNamed) {
  FlatDrive drive;
  drive.mount.robot_T_lidar = {0, 0, kPi};
  drive.scan_weather = [](Scan s) {
    s.mount = {};  // as configured
    return std::vector{std::move(s)};
  };
  drive.wheels = drive.fair<OdometrySample>;
  drive.run();
  EXPECT_THAT(drive.slam.findings(), ElementsAre(HasSubstr("the lidar sits backwards")));
}

TEST(SlamWeather, WheelsThatCountForwardWhenReversingDoNotMisleadTheRobot) {
  Route way({1.2, 2.45, 0});
  way.go(2.0).go(-1.5).go(1.0).go(-1.5).turn_by(1.0).go(0.8).go(-0.8);
  DrawnDrive drive(two_rooms(), way);
  Pose2 counted, last = way({});
  drive.wheels = [&](OdometrySample s) {
    Pose2 step = last.inverse() * way(s.stamp);
    step.x = std::abs(step.x);
    last = way(s.stamp);
    counted = counted * step;
    s.odom_T_robot = counted;
    return std::vector{s};
  };
  drive.until(way.end_s());
  EXPECT_LT(drive.worst_m(), 0.05);
}

// ---- scans and clocks ----

TEST(SlamWeather, ScansMayComeTwiceOrNotAtAll) {
  FlatDrive drive;
  int i = 0;
  drive.scan_weather = [&i](const Scan& s) {
    ++i;
    return i % 7 == 0 ? std::vector<Scan>{} : i % 3 == 0 ? std::vector{s, s} : std::vector{s};
  };
  drive.run();
  EXPECT_LT(drive.worst_m(), 0.05);
  EXPECT_EQ(drive.slam.counters()["slam.scans_out_of_order"], static_cast<std::size_t>(i / 3 - i / 21));
}

TEST(SlamWeather, ASecondMayPassWithoutScans) {
  for (const bool has_imu : {false, true}) {
    FlatDrive drive;
    if (has_imu) drive.imu = drive.fair<ImuSample>;
    drive.scan_weather = [](Scan s) {
      const double t_s = seconds_of(s.stamp);
      return t_s > kFails_s && t_s < kFails_s + 1.0 ? std::vector<Scan>{} : std::vector{std::move(s)};
    };
    drive.run();
    EXPECT_LT(drive.results.size(), 392U);
    EXPECT_LT(drive.worst_m(), 0.05) << has_imu;
  }
}

TEST(SlamWeather, TheClockMayBeSetBackByAnHour) {
  const auto set_back = [](auto sample) {
    if (seconds_of(sample.stamp) > kFails_s) sample.stamp -= std::chrono::hours(1);
    return std::vector{std::move(sample)};
  };
  for (const bool has_sensors : {false, true}) {
    FlatDrive drive;
    drive.scan_weather = set_back;
    if (has_sensors) drive.imu = set_back, drive.wheels = set_back;
    drive.run();
    EXPECT_GT(drive.results.size(), 395U);
    EXPECT_LT(drive.worst_m(), 0.05) << has_sensors;
    EXPECT_EQ(drive.map().share_off(drive.world, 0.05), 0.0) << has_sensors;
  }
}

TEST(SlamWeather, TheClockOfTheScansAloneMayBeSetBack) {
  FlatDrive drive;
  drive.imu = drive.fair<ImuSample>;
  drive.scan_weather = [](Scan s) {
    if (seconds_of(s.stamp) > kFails_s) s.stamp -= std::chrono::hours(1);
    return std::vector{std::move(s)};
  };
  drive.run();
  EXPECT_GT(drive.results.size(), 395U);
  EXPECT_LT(drive.worst_m(), 0.05);
}

TEST(SlamWeather, WhereTheLidarSeesNothingTheWheelsLead) {
  DrawnWorld hall;
  hall.add_box(0.007, 0.011, 40.013, 6.009);
  hall.add_box(2.0, 4.5, 3.0, 5.2);
  hall.add_box(4.5, 0.5, 5.0, 1.2);
  Route way({2.0, 2.5, 0});
  way.go(3.0).go(3.0).turn_by(3.0).go(5.0).turn_by(1.0).go(0.5);
  constexpr double kBlind_s = 6.5, kSees_s = 9.5;
  for (const bool has_imu : {false, true}) {
    DrawnDrive drive(hall, way);
    drive.reach_m = 12.0;
    if (has_imu) drive.imu = drive.fair<ImuSample>;
    drive.wheels = drive.fair<OdometrySample>;
    drive.scan_weather = [](Scan s) {
      const double t_s = seconds_of(s.stamp);
      if (t_s > kBlind_s && t_s < kSees_s) {
        for (Beam& b : s.beams) b.range_m = std::numeric_limits<float>::infinity();
      }
      return std::vector{std::move(s)};
    };
    drive.until(way.end_s());
    const double blind_way_m =
        (way(time_at_s(kSees_s)).translation() - way(time_at_s(kBlind_s)).translation()).norm();
    EXPECT_GT(blind_way_m, 1.0);
    for (const ScanResult& r : drive.results) {
      const double t_s = drive.true_time_s(r);
      const bool is_blind = t_s > kBlind_s + 0.05 && t_s<kSees_s - 0.05, sees_again = t_s> kSees_s + 0.15;
      EXPECT_LT(r.quality, is_blind ? 0.2 : 1.1) << t_s;
      EXPECT_GT(r.quality, sees_again ? 0.5 : -0.1) << t_s;
      EXPECT_FALSE(r.lost);
    }
    EXPECT_LT(drive.worst_m(), 0.05);
  }
}

// ---- robots that are carried away ----

/// A robot that drives through the flat, is put down somewhere else, and drives on.
class Kidnapped : public DrawnDrive {
 public:
  explicit Kidnapped(const Pose2& put_down, bool has_imu = false)
      : DrawnDrive(two_rooms(),
                   [before = through_the_flat(), after = through_the_flat(put_down)](Time t) {
                     const Duration gone = from_seconds(taken_s());
                     return t - gone < Time{} ? before(t) : after(t - gone);
                   }),
        ends_s_(taken_s() + through_the_flat(put_down).end_s()) {
    if (has_imu) imu = fair<ImuSample>;
    until(ends_s_);
  }
  static double taken_s() { return 0.1 * std::ceil(through_the_flat().end_s() * 10.0); }
  double worst_of_last_5_s() const { return worst_m(ends_s_ - 5.0); }
  /// Scans from when it was put down until one for which `is` holds; nothing if there is none.
  template <class Is>
  std::optional<int> scans_until(Is&& is) const {
    int n = 0;
    for (const ScanResult& r : results) {
      if (true_time_s(r) < taken_s() - 0.05) continue;
      if (is(r)) return n;
      ++n;
    }
    return std::nullopt;
  }
  std::optional<int> scans_until_lost() const {
    return scans_until([](const ScanResult& r) { return r.lost; });
  }
  std::optional<int> scans_until_found() const {
    bool was_lost = false;
    return scans_until([&](const ScanResult& r) { return std::exchange(was_lost, r.lost) && !r.lost; });
  }
  /// Until a wrong pose is passed off as good.
  std::optional<int> scans_until_deceived() const {
    return scans_until(
        [&](const ScanResult& r) { return r.quality > 0.5 && error(r).translation().norm() > 0.1; });
  }

 private:
  double ends_s_;
};

const Pose2 kMetreAside{3.0, 2.45, 0}, kMetreAslant{2.6, 3.25, 0}, kMetreBelow{2.0, 1.45, 0},
    kOtherRoom{6.5, 2.6, 1.0};

TEST(SlamWeather, AKidnappedRobotSaysThatItIsLost) {
  for (const Pose2& put_down : {kMetreAside, kMetreAslant}) {
    const Kidnapped drive(put_down);
    EXPECT_LE(drive.scans_until_lost().value_or(99), 25);
    EXPECT_EQ(drive.scans_until_deceived(), std::nullopt);
    for (const ScanResult& r : drive.results) {
      EXPECT_FALSE(r.lost && drive.true_time_s(r) < drive.taken_s() - 0.05);
      EXPECT_LE(r.quality, r.lost ? 0.4 : 1.0);
    }
  }
}

TEST(SlamWeather, AKidnappedRobotFindsItselfAgain) {
  for (const Pose2& put_down : {kMetreAside, kMetreAslant}) {
    Kidnapped drive(put_down);
    EXPECT_NE(drive.scans_until_found(), std::nullopt);
    EXPECT_LT(drive.worst_of_last_5_s(), 0.05);
    drive.finish();
    EXPECT_LT(drive.map().share_off(drive.world, 0.05), 0.01);
  }
}

TEST(SlamWeather, AKidnappedRobotFindsItselfInAnotherRoomByItsImu) {
  Kidnapped drive(kOtherRoom, true);
  EXPECT_LE(drive.scans_until_lost().value_or(99), 25);
  EXPECT_NE(drive.scans_until_found(), std::nullopt);
  EXPECT_LT(drive.worst_of_last_5_s(), 0.05);
  drive.finish();
  EXPECT_LT(drive.map().share_off(drive.world, 0.05), 0.01);
}

TEST(SlamWeather, TheCovarianceOfAKidnappedRobotCoversWhereItIs) {
  const Kidnapped drive(kMetreAside);
  for (const ScanResult& r : drive.results) {
    if (!r.lost) continue;
    EXPECT_GT(std::sqrt(r.covariance(0, 0)), 0.5 * std::abs(drive.error(r).x));
    EXPECT_GT(std::sqrt(r.covariance(2, 2)), 0.5 * std::abs(drive.error(r).yaw));
  }
}

/// The flat, with scans that are noise for a while.
FlatDrive drive_blinded(bool has_wheels) {
  FlatDrive drive;
  if (has_wheels) drive.wheels = drive.fair<OdometrySample>;
  drive.scan_weather = [&](Scan s) {
    std::uniform_real_distribution<float> range(0.3F, 6.0F);
    const double t_s = seconds_of(s.stamp);
    if (t_s > kFails_s && t_s < kFails_s + 3.5) {
      for (Beam& b : s.beams) b.range_m = range(drive.random);
    }
    return std::vector{std::move(s)};
  };
  drive.run();
  return drive;
}

TEST(SlamWeather, ABlindRobotKnowsByItsWheelsAboutWhereItIs) {
  const FlatDrive drive = drive_blinded(true);
  int lost = 0;
  for (const ScanResult& r : drive.results) {
    lost += r.lost ? 1 : 0;
    EXPECT_LT(std::sqrt(r.covariance(0, 0)), 2.0) << r.lost;
  }
  EXPECT_GT(lost, 5);
  EXPECT_FALSE(drive.results.back().lost);
  EXPECT_LT(drive.worst_m(), 0.6);
  EXPECT_LT(drive.worst_m(seconds_of(drive.results.back().stamp) - 2.0), 0.05);
}

TEST(SlamWeather, ABlindRobotWithoutWheelsOwnsToKnowNothing) {
  const FlatDrive drive = drive_blinded(false);
  int lost = 0;
  for (const ScanResult& r : drive.results) {
    if (!r.lost) continue;
    ++lost;
    EXPECT_GT(std::sqrt(r.covariance(0, 0)), 10.0);
  }
  EXPECT_GT(lost, 5);
}

TEST(SlamWeather, AKidnappedRobotThatIsNotFarMayFindItselfAtOnce) {
  Kidnapped drive({2.4, 2.85, 0}, true);
  EXPECT_EQ(drive.scans_until_lost(), std::nullopt);
  EXPECT_EQ(drive.scans_until_deceived(), std::nullopt);
  const auto sure = [](const ScanResult& r) { return r.quality > 0.5; };
  EXPECT_GE(drive.scans_until(sure).value_or(99), 3) << "other scans have to bear it out";
  EXPECT_LE(drive.scans_until(sure).value_or(99), 10);
  EXPECT_LT(drive.worst_of_last_5_s(), 0.05);
  drive.finish();
  EXPECT_EQ(drive.map().share_off(drive.world, 0.05), 0.0);
}

TEST(SlamWeather, AKidnappedRobotIsNotSureOfAWrongPose) {
  // The last looks much like where it was taken, turned by half a turn.
  for (const Pose2& put_down : {kOtherRoom, Pose2{2.59, 1.94, -2.07}})
    EXPECT_EQ(Kidnapped(put_down, false).scans_until_deceived(), std::nullopt) << put_down.x;
  for (const Pose2& put_down : {kMetreAside, kMetreBelow, kOtherRoom})
    EXPECT_EQ(Kidnapped(put_down, true).scans_until_deceived(), std::nullopt) << put_down.x;
}

// ---- mirrors ----

TEST(SlamWeather, MirrorsDoNotLoseTheRobot) {
  FlatDrive drive;
  drive.imu = drive.fair<ImuSample>;
  drive.mirrors.walls = {{{2.2, 4.99}, {4.3, 4.99}}, {{7.99, 1.2}, {7.99, 4.8}}, {{0.03, 1.0}, {0.03, 3.3}}};
  drive.run();
  EXPECT_GT(drive.map().share_off(drive.world, 0.05), 0.2) << "the rooms behind the mirrors are seen";
  EXPECT_LT(drive.worst_m(), 0.05);
  for (const ScanResult& r : drive.results) EXPECT_FALSE(r.lost);
}

TEST(SlamWeather, GlassThatShowsItselfNowAndThenDoesNotLoseTheRobot) {
  FlatDrive drive;
  drive.imu = drive.fair<ImuSample>;
  drive.world.walls[0].to.x() = 2.0;  // the lower wall has a window, and a garden wall stands outside
  drive.world.walls.push_back({{3.9, 0.011}, {8.013, 0.011}});
  drive.world.walls.push_back({{0.0, -2.0}, {8.0, -2.6}});
  const DrawnWorld glass{{{{2.0, 0.011}, {3.9, 0.011}}}};
  std::bernoulli_distribution shows(0.3);
  drive.scan_weather = [&](Scan s) {
    const Pose2 robot = drive.world_T_robot(s.stamp);
    for (Beam& b : s.beams) {
      const double range = glass.distance(robot.translation(), robot.yaw + b.angle_rad);
      if (range < b.range_m && shows(drive.random)) b.range_m = static_cast<float>(range);
    }
    return std::vector{std::move(s)};
  };
  drive.run();
  EXPECT_LT(drive.worst_m(), 0.05);
  for (const ScanResult& r : drive.results) EXPECT_FALSE(r.lost);
}

}  // namespace
}  // namespace dynslam
