// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "sim/actors.h"
#include "sim/imu_model.h"
#include "sim/lidar_model.h"
#include "sim/ray_caster.h"
#include "sim/robot_body.h"

namespace dynslam {

/// What the camera needs to draw a moment.
struct CameraView {
  Time stamp;
  BodyPose pose;
  std::vector<Surface> moving;
};

/// Where the robot truly was.
struct TruePose {
  Time stamp;
  Pose2 world_T_robot;
};

/// How much room there is around the robot, at most Life::kMostRoom_m.
struct Room {
  double to_things_m = 0.0, to_people_m = 0.0;
};

/// The world and the robot in it, in steps of fixed length, so that what happens does not depend on who asks
/// how often. Sensors measure as time goes by and leave their samples in outboxes. No clock, one thread.
class Life {
 public:
  Life(const World& world, Time begin, std::uint64_t seed);
  Life(const Life&) = delete;
  Life& operator=(const Life&) = delete;

  Time now() const { return now_; }
  void step();
  static constexpr Duration kStep = std::chrono::milliseconds(2);

  /// What the motor board was told, and when. It stops the motors by itself when it hears nothing for
  /// kFailsafe.
  void command(const WheelPower& power, Time heard);
  static constexpr Duration kFailsafe = std::chrono::milliseconds(250);

  /// Puts the robot down elsewhere; false, and nothing happens, where something stands.
  bool place(const Pose2& world_T_robot);
  /// See Simulator::reachable_floor.
  std::vector<Vector2> reachable_floor(double step_m) const;
  /// Between the body and whatever it would run into.
  Room room() const;
  static constexpr double kMostRoom_m = 0.5;
  /// A face that the robot is pressed to.
  std::optional<Surface> touched() const;
  /// See Actors::move_door.
  void move_door(std::size_t door, double open) { actors_.move_door(door, open); }
  /// Things as they stand, for beams.
  const RayCaster& caster() const { return caster_; }
  RobotBody& body() { return body_; }
  const RobotBody& body() const { return body_; }
  /// 100 a second, the last of them kTruthKept old at most, oldest first.
  const std::deque<TruePose>& truth() const { return truth_; }
  static constexpr Duration kTruthKept = std::chrono::minutes(5);

  Time next_scan_due() const { return scans.next_due().value_or(lidar_.next_due()); }
  Time next_imu_due() const { return imu.next_due().value_or(imu_.next_due()); }
  Time next_view_due() const { return views.next_due().value_or(last_view_ + kViewPeriod); }

  Outbox<Scan> scans{8};
  Outbox<ImuSample> imu{64};
  Outbox<CameraView> views{1};

  static constexpr Duration kViewPeriod = std::chrono::milliseconds(50);

 private:
  bool is_within(const Vector2& p) const;
  bool is_blocked(const Pose2& world_T_robot) const;
  bool is_in_something(const Vector2& p) const;
  bool could_stand_at(const Vector2& p) const;
  void move_actors();
  void note_truth();

  Time begin_, now_;
  std::uint64_t steps_ = 0;
  Actors actors_;
  RayCaster caster_;
  RobotBody body_;
  RobotBody::Blocked blocked_;
  LidarModel lidar_;
  ImuModel imu_;
  std::array<BodyPose, 4> recent_;  ///< by steps: where the robot was
  std::deque<TruePose> truth_;
  Time last_view_;
  WheelPower wanted_;
  Time heard_;
};

}  // namespace dynslam
