// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "drive/drawn_scan.h"
#include "drive/path_follower.h"
#include "drive/speed_control.h"
#include "drive/speed_ramp.h"

namespace dynslam {

/// What is wrong with a robot and with what it knows.
struct ToyFaults {
  double speed_gain = 1.0, turn_gain = 1.0;
  double lag_s = 0.15;
  double turn_deadband_radps = 0.0;  ///< slower turns on the spot do not move it
  double pose_noise_m = 0.0, pose_noise_rad = 0.0;
  int pose_age_ms = 0;
  bool extrapolates = true;  ///< the old pose, by what was driven since
  bool corrects = false;     ///< with SpeedControl
};

/// From the robot's rectangle to the nearest wall or post; 0: it touches.
inline double gap_m(const DrawnWorld& world, const Pose2& world_T_robot, const BodyConfig& body = {}) {
  const Pose2 robot_T_world = world_T_robot.inverse();
  double gap = std::numeric_limits<double>::infinity();
  const auto touch = [&](const Vector2& p, double radius) {
    const Vector2 q = robot_T_world * p;
    const double x = std::max(0.0, std::abs(q.x()) - body.half_length_m());
    const double y = std::max(0.0, std::abs(q.y()) - body.half_width_m());
    gap = std::min(gap, std::max(0.0, std::hypot(x, y) - radius));
  };
  for (const auto& w : world.walls) {
    const Vector2 from(w.x0, w.y0), to(w.x1, w.y1);
    // About the place that is nearest to the robot's middle.
    const double length = (to - from).norm();
    const double along = (world_T_robot.translation() - from).dot(to - from) / length;
    for (double at = along - 0.3; at <= along + 0.3; at += 0.01)
      touch(from + (to - from) * std::clamp(at / length, 0.0, 1.0), 0.0);
  }
  for (const auto& p : world.posts) touch({p.x, p.y}, p.radius);
  return gap;
}

/// A robot on a drawn floor that obeys a PathFollower: lidar at 10 Hz, commands at 20 Hz, acceleration
/// limits, wheels that lag.
class ToyRobot {
 public:
  ToyRobot(DrawnWorld drawn, const ToyFaults& with, const Pose2& start = {}, unsigned seed = 1)
      : world(std::move(drawn)), pose(start), faults(with), random_(seed) {
    scan();
  }

  /// 50 ms.
  FollowOutput tick() {
    if (ticks_++ % 2 == 0) scan();
    const Pose2 believed = believed_pose();
    const Twist measured{twist.v_mps, twist.w_radps};
    FollowOutput out = follower.next({now, believed, measured}, motion);
    const bool free = !is_moving(out.twist) || share_of(out.twist) > 0.0;
    if (!free) ++unfree_commands;
    if (!is_finite(out.twist)) ++nonsense;
    most_jerk_v = std::max(most_jerk_v, std::abs(out.twist.v_mps - wanted.v_mps));
    most_jerk_w = std::max(most_jerk_w, std::abs(out.twist.w_radps - wanted.w_radps));
    wanted = out.twist;
    if (wanted.v_mps < 0.0) ++backwards;
    if (wanted.v_mps == 0.0 && wanted.w_radps != 0.0) turned_on_spot_s += 0.05;
    if (wanted.v_mps > 0.0 && wanted.w_radps != 0.0) {
      if (wanted.w_radps * last_turn_ < 0.0) ++turn_changes;
      last_turn_ = wanted.w_radps;
    }
    Twist told = faults.corrects ? control.correct(now, wanted, ramp_.now(), measured) : wanted;
    ramp_.set(ramp_.toward(told, std::chrono::milliseconds(50)));
    motion.add(now, ramp_.now(), std::nullopt);
    for (int i = 0; i < 5; ++i) step(0.01);
    least_gap_m = std::min(least_gap_m, gap_m(world, pose));
    now += std::chrono::milliseconds(50);
    return out;
  }

  /// Until one of the states that are asked for, or the time is over.
  FollowOutput run(double seconds, const std::function<bool(const FollowOutput&)>& until) {
    FollowOutput out;
    const Time end = now + from_seconds(seconds);
    while (now < end) {
      out = tick();
      if (until(out)) return out;
    }
    return out;
  }
  FollowOutput run_to_end(double seconds) {
    return run(seconds, [](const FollowOutput& o) {
      return o.state == Following::kArrived || o.state == Following::kStuck || o.state == Following::kBlocked;
    });
  }
  void run_on(double seconds) {
    run(seconds, [](const FollowOutput&) { return false; });
  }
  double seconds() const { return seconds_of(now); }

  DrawnWorld world;
  Pose2 pose;         ///< the true one
  Pose2 map_T_world;  ///< where it is believed to be differs by this
  Twist twist;        ///< the true one
  Twist wanted;       ///< by the follower
  ToyFaults faults;
  FollowerConfig config;
  PathFollower follower{config};
  SpeedControl control;
  RecentMotion motion;
  Time now;
  bool slips = false;  ///< the wheels turn in vain

  double least_gap_m = std::numeric_limits<double>::infinity();
  double driven_m = 0.0, turned_on_spot_s = 0.0;
  double most_jerk_v = 0.0, most_jerk_w = 0.0;
  int turn_changes = 0;  ///< from left to right and back, while driving
  int unfree_commands = 0, nonsense = 0, backwards = 0;

 private:
  void scan() {
    const Scan seen = scan_of(world, now, 360, pose);
    follower.see(seen, motion);
    judge_.see(seen, motion);
  }
  double share_of(const Twist& t) const { return judge_.way(now, t, motion).share; }

  Pose2 believed_pose() {
    std::normal_distribution<double> normal;
    Pose2 seen = pose;
    Time taken = now;
    const Duration age = std::chrono::milliseconds(faults.pose_age_ms);
    for (const auto& [when, was] : past_)
      if (when <= now - age) seen = was, taken = when;
    if (past_.empty() || age == Duration(0)) seen = pose, taken = now;
    past_.push_back({now, pose});
    if (past_.size() > 20) past_.pop_front();
    if (faults.extrapolates) seen = seen * motion.between(taken, now);
    const Pose2 noisy{seen.x + faults.pose_noise_m * normal(random_),
                      seen.y + faults.pose_noise_m * normal(random_),
                      seen.yaw + faults.pose_noise_rad * normal(random_)};
    return map_T_world * noisy;
  }

  void step(double s) {
    Twist goal{ramp_.now().v_mps * faults.speed_gain, ramp_.now().w_radps * faults.turn_gain};
    const bool on_spot = std::abs(goal.v_mps) < 0.02;
    if (on_spot && std::abs(goal.w_radps) < faults.turn_deadband_radps) goal.w_radps = 0.0;
    if (slips) goal = {};
    twist.v_mps += s / faults.lag_s * (goal.v_mps - twist.v_mps);
    twist.w_radps += s / faults.lag_s * (goal.w_radps - twist.w_radps);
    const double half = 0.5 * twist.w_radps * s;
    pose = pose * Pose2{twist.v_mps * s * std::cos(half), twist.v_mps * s * std::sin(half), 2.0 * half};
    driven_m += std::abs(twist.v_mps) * s;
  }

  std::mt19937 random_;
  Clearance judge_;
  SpeedRamp ramp_;
  std::deque<std::pair<Time, Pose2>> past_;
  double last_turn_ = 0.0;
  int ticks_ = 0;
};

}  // namespace dynslam
