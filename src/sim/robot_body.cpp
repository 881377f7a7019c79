// SPDX-License-Identifier: MIT
#include "sim/robot_body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/geometry.h"

namespace dynslam {
namespace {

// The motors of one side together.
constexpr double kCoil_ohm = 1.2;
constexpr double kLimit_a = 5.0;         // of the board, a channel
constexpr double kRolling_v = 0.96;      // voltage spent on friction: less than that moves nothing
constexpr double kScrubbing_v = 1.0;     // and what turning on the spot takes on top
constexpr double kIdle_a = 0.8;          // computer and lidar
constexpr double kBackEmf_vpmps = 5.52;  // such that a full battery at full power gives the top speed
constexpr double kGrip_mps2 = 6.0;       // what the tyres can push before they spin
constexpr double kSlip = 0.02;
constexpr double kFreeAgain_s = 0.3;  // a contact that pauses for longer is over

double sign(double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; }

}  // namespace

Eigen::Quaterniond BodyPose::level_q_robot() const {
  return Eigen::Quaterniond(Eigen::AngleAxisd(-nose_up_rad, Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(left_up_rad, Eigen::Vector3d::UnitX()));
}

Eigen::Quaterniond BodyPose::world_q_robot() const {
  return Eigen::AngleAxisd(world_T_robot.yaw, Eigen::Vector3d::UnitZ()) * level_q_robot();
}

BodyPose interpolate(const BodyPose& a, const BodyPose& b, double t) {
  const auto between = [t](double from, double to) { return from + t * (to - from); };
  return {interpolate(a.world_T_robot, b.world_T_robot, t), between(a.nose_up_rad, b.nose_up_rad),
          between(a.left_up_rad, b.left_up_rad), between(a.lift_m, b.lift_m)};
}

RobotBody::RobotBody(const World& world, std::uint64_t seed) : doorsteps_(world.doorsteps), random_(seed, 1) {
  pose_.world_T_robot = world.world_T_start;
}

double RobotBody::turn_wheels(Side& side, double power, double friction_v, double dt_s) {
  const double volts = power * std::max(0.0, battery_.voltage_v());
  const double pushing = std::max(0.0, std::abs(volts) - friction_v) * sign(volts);
  side.rim_mps += (pushing / kBackEmf_vpmps - side.rim_mps) * dt_s / kMotorLag_s;
  const double most = kGrip_mps2 * dt_s;
  side.ground_mps += std::clamp(side.rim_mps - side.ground_mps, -most, most);
  const double driving_v =
      (volts - kBackEmf_vpmps * side.rim_mps) * sign(volts);  // braking feeds nothing back
  return std::abs(power) * std::clamp(driving_v / kCoil_ohm, 0.0, kLimit_a);
}

void RobotBody::step(double dt_s, const Blocked& blocked) {
  const double both = std::abs(power_.left) + std::abs(power_.right);
  const double turning = both > 0 ? std::abs(power_.left - power_.right) / both : 0.0;
  const double friction_v = kRolling_v + kScrubbing_v * turning;
  const double left_a = turn_wheels(left_, power_.left, friction_v, dt_s);
  const double right_a = turn_wheels(right_, power_.right, friction_v, dt_s);
  battery_.step(kIdle_a + left_a + right_a, dt_s);
  const double left = left_.ground_mps * (1.0 - kSlip + left_.slip.step(dt_s, random_));
  const double right = right_.ground_mps * (1.0 - kSlip + right_.slip.step(dt_s, random_));
  twist_ = {(left + right) / 2, (right - left) / (kTrack_m * kTurningLoss)};
  move(dt_s, blocked);
  settle_on_floor(dt_s);
}

void RobotBody::move(double dt_s, const Blocked& blocked) {
  since_contact_s_ += dt_s;
  const double sideways_m = twist_.w_radps * sideways_.step(dt_s, random_) * dt_s;
  if (twist_ == Twist{}) {
    if (pressed_to_ && !blocked(*pressed_to_)) pressed_to_.reset();  // it has gone away
    return;
  }
  pressed_to_.reset();
  const double turned = twist_.w_radps * dt_s, ahead = twist_.v_mps * dt_s;
  const auto moved = [&](double m, double rad) {
    const Vector2 by = m * unit(rad / 2) + sideways_m * Vector2(0, 1);
    return pose_.world_T_robot * Pose2{by.x(), by.y(), rad};
  };
  // Against a wall it may still turn, or roll along without turning.
  for (const Pose2& next : {moved(ahead, turned), moved(0, turned), moved(ahead, 0)}) {
    if (blocked(next)) {
      if (since_contact_s_ > kFreeAgain_s) ++contacts_;
      since_contact_s_ = 0.0;
      if (!pressed_to_) pressed_to_ = next;
      continue;
    }
    const Vector2 by = next.translation() - pose_.world_T_robot.translation();
    distance_m_ += by.norm();
    const double free_turn = turn(pose_.world_T_robot.yaw, next.yaw);
    if (since_contact_s_ == 0.0) {  // what was stopped has lost its swing
      twist_ = {by.norm() / dt_s * sign(twist_.v_mps), free_turn / dt_s};
      left_.rim_mps = left_.ground_mps = twist_.v_mps - twist_.w_radps * kTrack_m * kTurningLoss / 2;
      right_.rim_mps = right_.ground_mps = twist_.v_mps + twist_.w_radps * kTrack_m * kTurningLoss / 2;
    }
    pose_.world_T_robot = next;
    return;
  }
  twist_ = {};
  for (Side* side : {&left_, &right_}) side->rim_mps = side->ground_mps = 0.0;
}

double RobotBody::floor_height(const Vector2& p) const {
  double height = 0.0;
  for (const Doorstep& step : doorsteps_) {
    const double off = distance_to_segment(p, step.from, step.to) - step.depth_m / 2;
    // A wheel touches an edge of height h while its axle is still sqrt(2 r h) away.
    const double ramp = std::sqrt(2.0 * kWheelRadius_m * step.height_m);
    if (off >= ramp) continue;
    height = std::max(height, step.height_m * (off <= 0 ? 1.0 : 0.5 + 0.5 * std::cos(kPi * off / ramp)));
  }
  return height;
}

void RobotBody::settle_on_floor(double dt_s) {
  if (doorsteps_.empty()) return;
  constexpr double kSettling_s = 0.015;
  const auto height_at = [&](double x, double y) {
    return floor_height(pose_.world_T_robot * Vector2(x, y));
  };
  const double x = kWheelBase_m / 2, y = kTrack_m / 2;
  const double front_left = height_at(x, y), front_right = height_at(x, -y);
  const double rear_left = height_at(-x, y), rear_right = height_at(-x, -y);
  const double share = dt_s / kSettling_s;
  const auto approach = [share](double& value, double target) { value += (target - value) * share; };
  approach(pose_.nose_up_rad, (front_left + front_right - rear_left - rear_right) / 2 / kWheelBase_m);
  approach(pose_.left_up_rad, (front_left + rear_left - front_right - rear_right) / 2 / kTrack_m);
  approach(pose_.lift_m, (front_left + front_right + rear_left + rear_right) / 4);
}

void RobotBody::place(const Pose2& world_T_robot) {
  pose_ = {world_T_robot, 0.0, 0.0, 0.0};
  pressed_to_.reset();
  twist_ = {};
  for (Side* side : {&left_, &right_}) side->rim_mps = side->ground_mps = 0.0;
}

}  // namespace dynslam
