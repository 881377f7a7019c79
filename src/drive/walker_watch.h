// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "drive/body_config.h"
#include "drive/obstacle_points.h"
#include "drive/sight.h"

namespace dynslam {

/// Who walks, as a lidar near the floor sees him: things as wide as a leg that were seen to move. Somebody
/// who stands takes a step when he likes, so room for one is left around his legs for a while. Glass, whose
/// patch moves along with the robot, does not walk, nor does what is seen between other things. One thread.
class WalkerWatch {
 public:
  explicit WalkerWatch(double blind_m) : blind_m_(blind_m) {}

  /// So long after a step the next one is reckoned with.
  static constexpr Duration kStands = std::chrono::seconds(8);
  /// From the middle of what is seen of a leg: so far a step brings it before the robot has stopped.
  static constexpr double kStep_m = 0.15;

  /// `points`: of the scan, in the order of its beams, from the robot.
  void see(std::span<const ObstaclePoint> points, const Look& look);
  /// Adds a ring around each leg, as far as it is not inside of the robot.
  void add_to(std::vector<ObstaclePoint>& points, const BodyConfig& body) const;
  void forget() { legs_.clear(); }

 private:
  /// Places from the robot.
  struct Leg {
    Vector2 at;
    Time seen;
    Vector2 from, lidar_from;  ///< where it was, and the lidar,
    Time from_at;              ///< a moment ago
    std::optional<Time> stepped;
  };
  void carry(const Look& look);
  void follow(const Vector2& at, Time now);
  bool has_stepped(const Leg& leg) const;
  bool is_gone(const Leg& leg, const Look& look) const;

  double blind_m_;
  Time end_;                         ///< of the last scan
  Vector2 lidar_ = Vector2::Zero();  ///< where it is on the robot
  std::vector<Leg> legs_;            ///< and what else is as wide
};

}  // namespace dynslam
