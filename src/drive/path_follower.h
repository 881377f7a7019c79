// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
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
  bool held = false;  ///< what it asks for is not driven: who guards it sees something in the way
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
/// newest scan and gives way to a neighbouring one that is free. Drives forward; turns on the spot when it
/// faces away from the route, when no arc is free, and for the heading at the goal; and where there is no
/// room for a turn, a little straight back. Does not turn again into what it touched in a turn, for the lidar
/// does not see that. Commands nothing that Clearance calls not free. Pure; one thread.
class PathFollower {
 public:
  explicit PathFollower(const FollowerConfig& config = {}, const BodyConfig& body = {},
                        const ClearanceConfig& clearance = {});

  /// From now on this. The same id: the errand goes on, from wherever along the new route the robot is.
  void follow(const DriveTask& task);
  void halt();
  /// The newest scan.
  void see(const Scan& scan, const RecentMotion& motion) { clearance_.see(scan, motion); }
  /// Of glass that is seen, from the robot at the end of the newest scan.
  std::vector<Segment> panes() const { return clearance_.panes(); }
  /// Whether a bumper is pressed, by what was asked for last. To be told of it each time, before halt().
  void feel(bool touches);
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
  /// On the spot.
  struct Turn {
    Twist twist;
    ClearWay way;
    bool is_enough;  ///< of it is free
  };
  void estimate(const FollowInputs& in);
  void find_progress();
  std::optional<FollowOutput> come_to_goal(const Tick& tick);
  bool faces_goal_heading(const Tick& tick) const;
  bool is_at_rest(Time now) const;
  FollowOutput watch_motion(const FollowInputs& in, FollowOutput out);
  FollowOutput rest(Following state, std::string reason = {});
  double remaining_m() const { return route_.length_m() - progress_m_; }
  bool is_near_goal() const { return remaining_m() <= 2.0 * config_.pass_m; }

  FollowOutput drive(const Tick& tick);
  Vector2 aim_robot() const;
  double most_curvature_1pm() const;
  double curvature_to(const Vector2& to_robot) const;
  std::optional<Arc> arc_for(const Tick& tick, const Vector2& to_robot, double wanted_1pm,
                             double wanted_mps) const;
  void note_hindrance(Time now, bool wanted_is_free);
  FollowOutput hindered(Time now, const ClearWay& way);
  void begin_turn(double left_rad);
  bool is_to_turn(const Tick& tick, double off_rad);
  bool would_touch(int side, double left_rad) const;
  Turn turn_to(const Tick& tick, int side, double left_rad) const;
  FollowOutput turn_by(const Tick& tick, double left_rad, bool may_back);
  std::optional<Twist> back_out(const Tick& tick) const;
  double speed_for(const Tick& tick, double curvature_1pm) const;
  double corner_speed_mps() const;
  double allowed_mps(const Tick& tick, double curvature_1pm) const;

  FollowerConfig config_;
  BodyConfig body_;
  ClearanceConfig room_;
  Clearance clearance_;

  std::optional<DriveTask> task_;
  Route route_;
  std::string problem_;     ///< with the task; empty: none
  Time followed_at_;        ///< when the route came
  bool new_route_ = false;  ///< where along it the robot is must yet be found
  double progress_m_ = 0.0;
  std::optional<Time> at_goal_since_;   ///< but for the heading
  std::optional<std::string> arrived_;  ///< and what is not as it should be there
  int misses_ = 0;                      ///< of the goal
  bool stuck_ = false;                  ///< until follow()

  std::optional<Time> now_;
  Pose2 pose_;                    ///< of the robot in the map, smoothed
  double moved_m_ = 0;            ///< of the pose, since the last time
  Twist last_;                    ///< commanded
  std::optional<Time> moved_at_;  ///< when it last was told to move, or seen to turn
  int turning_ = 0;               ///< on the spot: 1 left, -1 right
  bool turned_back_ = false;      ///< this turn was tried the other way round
  /// Where it touched something while it turned on the spot, and to which side it did.
  struct FeltTurn {
    Pose2 pose;
    int side;
  };
  std::deque<FeltTurn> felt_turns_;
  bool touches_ = false;
  double backed_m_ = 0.0;       ///< to make room for it
  double backs_until_m_ = 0.0;  ///< of these
  std::optional<Time> hindered_at_;
  double hindered_remaining_m_ = 0.0;
  std::optional<Time> held_at_;  ///< last
  Pose2 anchor_;                 ///< where it was when it last was seen to move,
  Time anchor_at_;               ///< and when
};

}  // namespace dynslam
