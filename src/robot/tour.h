// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/drive_command.h"
#include "base/pose_estimate.h"
#include "base/verdict.h"

namespace dynslam {

struct TourConfig {
  double speed_mps = 0.5;
  double turn_radps = 1.2;
  double arrived_m = 0.2;    ///< this near to a point it is reached
  double blocked_s = 8.0;    ///< a point that cannot be neared for so long is blocked
  int tries = 5;             ///< so often it drives back a leg and tries again, then the point is left out
  double patience_s = 60.0;  ///< lost or stopped for so long without a break, it gives up
  double look_round_radps = 0.6;
};

/// Drives from point to point as a person would who sees the map: by commands, through everything that guards
/// a person's commands. Pure; one thread.
class Tour {
 public:
  explicit Tour(std::vector<Vector2> points_map, const TourConfig& config = {});

  /// What to command now, where the robot believes to be `pose`, the newest one.
  Twist next(Time now, const PoseEstimate& pose, const Verdict& verdict);

  bool done() const { return at_ >= points_.size(); }
  /// Why it goes no further, once it gave up.
  const std::optional<std::string>& gave_up() const { return gave_up_; }
  std::size_t reached() const { return reached_; }
  std::size_t skipped() const { return skipped_; }

 private:
  Vector2 target() const;
  void come_to_blocked_point();
  Twist wait(Time now, const std::string& trouble, double turn_radps);
  Twist towards(const Vector2& point, const Pose2& map_T_robot) const;
  void leave_point(bool reached);

  std::vector<Vector2> points_;
  TourConfig config_;
  std::size_t at_ = 0, reached_ = 0, skipped_ = 0;
  int tries_ = 0;         ///< at the point, in vain
  bool backing_ = false;  ///< on the way back to the point before
  double nearest_m_ = 0.0;
  std::optional<Time> nearer_at_;   ///< when it came nearer to the point last
  std::optional<Time> held_up_at_;  ///< since then it is lost or stopped
  std::optional<std::string> gave_up_;
};

}  // namespace dynslam
