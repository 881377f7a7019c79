// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "autopilot/autopilot_config.h"
#include "autopilot/exploration.h"
#include "autopilot/frontier_map.h"
#include "autopilot/visit_map.h"
#include "base/pose_estimate.h"
#include "plan/path_planner.h"

namespace dynslam {

/// The errand to find out what is there: which place to drive to now, whether it is worth it still, and when
/// all is seen. Pure; one thread.
class Explorer {
 public:
  Explorer(const ExplorationConfig& exploration, AutopilotConfig autopilot)
      : config_(std::move(autopilot)), exploration_(exploration), frontier_map_(exploration) {}

  /// Keeps up with the map and with where the robot was, whoever drives.
  void observe(Time now, const GridSnapshot& map, const PoseEstimate& pose);
  /// Another errand: what was tried in vain stays known.
  void begin();
  /// Looks for the best place from time to time, and at once when there is none. Returns whether aim() is
  /// another than before.
  bool choose(Time now, const Vector2& robot_map, const Costmap& costmap, PathPlanner& planner);
  /// The robot is at aim().
  void reached(Time now);
  /// There was no way to aim().
  void failed(Time now);

  /// Nothing: there is nothing to drive to for now.
  const std::optional<Place>& aim() const { return aim_; }
  /// As of the last choice, the best first.
  const std::vector<Place>& places() const { return places_; }
  /// Nothing that can be reached is left to be seen for the first time.
  bool is_over() const { return over_; }
  /// A door was shut before something that is left to be seen.
  bool waits_for_door() const { return door_.has_value(); }

 private:
  bool goes_on() const { return config_.when_explored == "revisit"; }
  bool is_seen(const Place& place) const;
  bool holds_aim(Time now);
  void find_places(Time now, const Vector2& robot_map, const Costmap& costmap, PathPlanner& planner);
  void wait_well(Time now, const Vector2& robot_map);
  bool has_frontier() const { return !places_.empty() && places_.front().kind == PlaceKind::kFrontier; }
  void find_door(const std::vector<Frontier>& frontiers, const RouteLengths& lengths);
  void judge(Time now);

  AutopilotConfig config_;
  Exploration exploration_;
  FrontierMap frontier_map_;
  VisitMap visits_;
  GridSnapshot map_;
  std::optional<Place> aim_;
  Time aim_had_way_at_;                 ///< last, when there is an aim
  std::optional<Time> aim_seen_since_;  ///< what was to be seen there is no frontier any more
  std::vector<Place> places_;
  std::optional<Time> chosen_at_;
  std::optional<Place> door_;  ///< there was a way to that and there is none any more: where to wait for it
  std::optional<Vector2> aside_map_;       ///< there it is out of the way of a door, or of who comes through
  std::optional<Time> before_door_since_;  ///< since when it takes turns
  std::optional<Time> seems_over_since_, judged_at_;
  Duration hope_left_{};   ///< that a door opens
  Duration looks_left_{};  ///< for driving to doors for the first time
  bool over_ = false;
  bool seemed_over_ = false;  ///< once: what was tried in vain since has had its turn
  bool last_look_ = false;    ///< only what was hardly worth it is left
};

}  // namespace dynslam
