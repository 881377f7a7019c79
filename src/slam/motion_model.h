// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>

#include "base/imu_sample.h"
#include "base/odometry.h"
#include "slam/imu_track.h"
#include "slam/odometry_track.h"
#include "slam/passes.h"
#include "slam/scan_matcher.h"

namespace dynslam {

/// What is known of the robot's motion without looking at the map: IMU heading, wheel odometry, and the
/// velocity that the last matches showed. Each has its say where it exists: yaw from the IMU, else the
/// wheels, else the velocity; translation from the wheels, else the velocity. One thread.
class MotionModel {
 public:
  void add(const ImuSample& sample) { imu_.add(sample); }
  void add(const OdometrySample& sample) { odometry_.add(sample); }

  const ImuTrack& imu() const { return imu_; }
  const OdometryTrack& odometry() const { return odometry_; }

  /// Where the robot should be at `t`, and how far off that may be. The pose of the last fix before there is
  /// motion.
  MatchPrior expect(Time t) const;
  /// The same when the scan contradicts the wheels. Looks about widely: around where the velocity leads, or
  /// after longer than a velocity lasts, around where the wheels do.
  MatchPrior expect_doubting_wheels(Time t) const;
  /// Whether the wheels claim a leap, or a halt, that no robot makes at the speed it was seen to have: a
  /// count that stands still for a while and then catches up.
  bool wheels_leap(Time t) const;
  /// Whether the robot cannot have come here by itself, by how it was seen to move and by all its sensors.
  bool is_leap(Time t, const Pose2& map_T_robot) const;
  /// Where the wheels' way from a second and a half ago leads: right whether or not the robot was believed to
  /// stand while the count stood. Nothing without wheels.
  std::optional<MatchPrior> expect_by_longer_way(Time t) const;
  /// The motion around a scan's reference time, for the egomotion pass.
  MotionInScan motion_around(Time reference) const;

  /// Roll and pitch around a scan: level where the IMU is silent. Valid as long as this.
  TiltInScan tilt_around() const;

  /// How far the IMU turned, and how the wheels went, between two times; nothing where they are silent or not
  /// trusted any more.
  std::optional<double> imu_turn(Time from, Time to) const;
  std::optional<Pose2> wheel_motion(Time from, Time to) const;
  /// Whether the robot has wheels that tell, and that are believed.
  bool has_wheels() const { return wheels_trusted_ && odometry_.pose_at(time_).has_value(); }
  std::optional<double> imu_heading(Time t) const { return imu_trusted_ ? imu_.heading_at(t) : std::nullopt; }

  /// Takes the vote from a sensor that was found to contradict the lidar. Tilt stays in use.
  void distrust_imu() { imu_trusted_ = false; }
  void distrust_wheels() { wheels_trusted_ = false; }
  bool trusts_imu() const { return imu_trusted_; }

  /// The scan of time `t` was taken here: the velocity follows. `seen`: the map said so; otherwise this is
  /// but what was expected, and a velocity that nothing measures does not last.
  void fix(Time t, const Pose2& map_T_robot, bool seen = true);
  bool has_fix() const { return has_fix_; }
  const Pose2& last_pose() const { return pose_; }
  Time last_time() const { return time_; }
  /// Turning rate at a time, rad/s: the IMU's, else that of the last fixes.
  double yaw_rate(Time t) const;

 private:
  struct Velocity {  ///< in the robot's frame
    double x_mps = 0, y_mps = 0, yaw_radps = 0;
  };
  static MatchPrior by_wheels(const Pose2& from, const Pose2& step);
  void remember(Time t, const Pose2& map_T_robot);
  Pose2 carried_on(double seconds) const;

  ImuTrack imu_;
  OdometryTrack odometry_;
  bool imu_trusted_ = true, wheels_trusted_ = true;
  bool has_fix_ = false;
  Time time_;
  Time last_seen_;  ///< a fix by the map
  Pose2 pose_;
  Velocity velocity_;
  struct Fix {
    Time time;
    Pose2 map_T_robot;
  };
  std::deque<Fix> fixes_;  ///< of the last second and a half
};

}  // namespace dynslam
