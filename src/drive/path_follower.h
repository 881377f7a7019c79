// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drive/arc_choice.h"
#include "drive/clearance.h"
#include "drive/drive_task.h"
#include "drive/follower_config.h"
#include "drive/route.h"

namespace dynslam {

struct FollowInputs {
  Time now;
  Pose2 map_T_robot;  ///< now: the caller extrapolates
  Twist measured;     ///< as best known: yaw rate of the IMU, speed of SLAM; NaN: unknown
};

enum class Following {
  kIdle,     ///< nothing to drive
  kDriving,  ///< along the route
  kTurning,  ///< on the spot
  kWaiting,  ///< something is in the way and may go
  kBlocked,  ///< it does not go, or this route cannot be driven from here: another one is needed
  kStuck,    ///< told to move, and does not; stands still until follow()
  kArrived,
};
const char* to_string(Following state);

struct FollowOutput {
  Twist twist;  ///< finite
  Following state = Following::kIdle;
  double remaining_m = 0.0;  ///< along the route
  std::string reason;        ///< why it does not drive, for people
};

/// Turns a route into twists, 20 times a second: regulated pure pursuit (Coulter 1992; Macenski, Singh,
/// Martin and Gines, "Regulated Pure Pursuit for Robot Path Tracking", 2023) whose arc is checked against the
/// newest scan and gives way to a neighbouring one that is free. Drives forward only; turns on the spot when
/// it faces away from the route, when no arc is free, and for the heading at the goal. Commands nothing that
/// Clearance calls not free. Pure; one thread.
class PathFollower {
 public:
  explicit PathFollower(const FollowerConfig& config = {}, const BodyConfig& body = {},
                        const ClearanceConfig& clearance = {});

  /// From now on this. The same id: the errand goes on, from wherever along the new route the robot is.
  void follow(const DriveTask& task);
  void halt();
  /// The newest scan.
  void see(const Scan& scan, const RecentMotion& motion) { clearance_.see(scan, motion); }
  /// What to drive now. `motion` is what was driven since the scan. Stands still and says why when a number
  /// is none; a `now` before the last one begins its patience anew.
  FollowOutput next(const FollowInputs& in, const RecentMotion& motion);
  /// What is left of the route, from the robot.
  std::vector<Vector2> remaining() const;

 private:
  /// What does not change within a call of next().
  struct Tick {
    Time now;
    Twist measured;
    const RecentMotion& motion;
  };
  void estimate(const FollowInputs& in);
  void find_progress();
  std::optional<FollowOutput> come_to_goal(const Tick& tick);
  FollowOutput drive(const Tick& tick);
  std::optional<FollowOutput> turn_first(const Tick& tick, double off_rad);
  FollowOutput turn_by(const Tick& tick, double left_rad);
  FollowOutput hindered(Time now, const ClearWay& way);
  FollowOutput watch_motion(Time now, FollowOutput out);
  FollowOutput rest(Following state, std::string reason = {});
  double speed_for(const Tick& tick, double curvature_1pm) const;
  double allowed_mps(const Tick& tick, double curvature_1pm) const;
  double remaining_m() const { return route_.length_m() - progress_m_; }
  Vector2 robot_T(const Vector2& p_map) const { return pose_.inverse() * p_map; }

  FollowerConfig config_;
  BodyConfig body_;
  Clearance clearance_;

  std::optional<DriveTask> task_;
  Route route_;
  std::string problem_;     ///< with the task; empty: none
  Time followed_at_;        ///< when the route came
  bool new_route_ = false;  ///< where along it the robot is must yet be found
  double progress_m_ = 0.0;
  bool at_goal_ = false;  ///< but for the heading
  bool arrived_ = false;
  int misses_ = 0;      ///< of the goal
  bool stuck_ = false;  ///< until follow()

  std::optional<Time> now_;
  Pose2 pose_;                ///< of the robot in the map, smoothed
  double moved_m_ = 0;        ///< of the pose, since the last time
  Twist last_;                ///< commanded
  int turning_ = 0;           ///< on the spot: 1 left, -1 right
  bool turned_back_ = false;  ///< this turn was tried the other way round
  std::optional<Time> hindered_at_;
  double hindered_remaining_m_ = 0.0;
  Pose2 anchor_;    ///< where it was when it last was seen to move,
  Time anchor_at_;  ///< and when
};

}  // namespace dynslam
