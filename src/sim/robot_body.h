// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "base/motor_state.h"
#include "base/twist.h"
#include "sim/battery.h"
#include "sim/random_stream.h"
#include "sim/world.h"

namespace dynslam {

/// Where the robot is and how it stands on the floor.
struct BodyPose {
  Pose2 world_T_robot;
  double nose_up_rad = 0.0, left_up_rad = 0.0;
  double lift_m = 0.0;  ///< of its middle, by what its wheels stand on

  /// Turns robot axes into the world's.
  Eigen::Quaterniond world_q_robot() const;
  /// The same, short of heading.
  Eigen::Quaterniond level_q_robot() const;
};

/// A share `t` of the way from one to the other.
BodyPose interpolate(const BodyPose& a, const BodyPose& b, double t);

/// A skid-steered robot on four driven wheels: motors that lag and need some power to move at all, wheels
/// that slip, and more so in turns, a battery that sags. Constants are a MonsterBorg's, from its top speed
/// and the motors' and board's data; friction and slip are guesses.
class RobotBody {
 public:
  /// Whether the robot cannot be at a pose.
  using Blocked = std::function<bool(const Pose2&)>;

  RobotBody(const World& world, std::uint64_t seed);

  void set_power(const WheelPower& power) { power_ = power; }
  const WheelPower& power() const { return power_; }
  Battery& battery() { return battery_; }
  const Battery& battery() const { return battery_; }

  /// REQUIRES: the robot is not blocked where it is.
  void step(double dt_s, const Blocked& blocked);
  /// Puts it down elsewhere, standing.
  void place(const Pose2& world_T_robot);

  const BodyPose& pose() const { return pose_; }
  const Twist& twist() const { return twist_; }
  double distance_m() const { return distance_m_; }
  /// How often it ran into something; pressing on is the same contact, until it got free for a moment.
  int contacts() const { return contacts_; }
  /// Whether it touches what it ran into.
  bool touches() const { return pressed_to_.has_value(); }
  /// Where it would be by now, were there not what it touches.
  const std::optional<Pose2>& pressed_to() const { return pressed_to_; }

  static constexpr double kWheelBase_m = 0.13, kTrack_m = 0.19, kWheelRadius_m = 0.052;
  static constexpr double kTurningLoss = 1.6;  ///< the track behaves as if it were wider by this
  static constexpr double kTopSpeed_mps = 2.2;
  static constexpr double kMotorLag_s = 0.12;

 private:
  /// Wheels of one side.
  struct Side {
    double rim_mps = 0.0;     ///< what the wheels turn
    double ground_mps = 0.0;  ///< what they move the robot by
    Wandering slip{0.02, 0.7};
  };

  /// Turns one side's wheels for a step; returns the current they draw from the battery.
  double turn_wheels(Side& side, double power, double friction_v, double dt_s);
  void move(double dt_s, const Blocked& blocked);
  void settle_on_floor(double dt_s);
  double floor_height(const Vector2& p) const;

  std::vector<Doorstep> doorsteps_;
  RandomStream random_;
  Battery battery_;
  WheelPower power_;
  Side left_, right_;
  Wandering sideways_{0.004, 1.0};
  BodyPose pose_;
  Twist twist_;
  double distance_m_ = 0.0;
  int contacts_ = 0;
  double since_contact_s_ = 1e9;
  std::optional<Pose2> pressed_to_;
};

}  // namespace dynslam
