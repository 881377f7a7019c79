// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "plan/coarse_search.h"
#include "plan/costmap.h"
#include "plan/ground.h"
#include "plan/planner_config.h"
#include "plan/route_lengths.h"

namespace dynslam {

struct PlanRequest {
  Vector2 start_map;
  Vector2 goal_map;
  Unknown unknown = Unknown::kForbidden;
  std::vector<Vector2> in_vain_map = {};  ///< door_map of plans before: there it waited
};

enum class PlanOutcome {
  kFound,
  kNearby,  ///< ends near the goal, which is too tight
  kNoRoute,
};

struct Plan {
  PlanOutcome outcome = PlanOutcome::kNoRoute;
  std::vector<Vector2> route_map;  ///< from the start to the end, straight legs between
  double length_m = 0.0;
  std::string reason;       ///< why not to the goal, for people; empty when kFound
  bool is_cut_off = false;  ///< kNoRoute though the goal has room
  /// Of kNoRoute: where the reachable ground ends before what shuts the way that there was once, as a door
  /// does; none of those in `in_vain_map`.
  std::optional<Vector2> door_map;
  bool sees_door = false;  ///< nothing stands between the start and door_map
  /// Of kNoRoute: where to wait in sight of door_map; where there is none, what can be reached nearest to the
  /// goal.
  std::optional<Vector2> nearest_map;
};

/// Finds ways for a round robot. The way is searched on the coarse cells with the full margin, then pulled
/// taut in full resolution, where the pruning margin is enough. A route that starts where the robot has too
/// little room begins with the way out of there. Work is bounded by PlannerConfig::most_expansions.
///
/// Keeps its memory from one call to the next: 8 bytes for 4 x 4 cells of the map's box, and 7 and a bit more
/// for reach(). Threads: one at a time.
class PathPlanner {
 public:
  PathPlanner(const PlannerConfig& config, double robot_radius_m)
      : config_(config), robot_radius_m_(robot_radius_m) {}

  Plan plan(const Costmap& costmap, const PlanRequest& request);
  double goal_tolerance_m() const { return config_.goal_tolerance_m; }

  /// The first leg of a polyline that does not keep the pruning margin. Of the way out of a tight place or a
  /// pocket, up to way_out_reach_m() from the first point, only what is occupied counts, and what is
  /// forbidden unless the first point is so. What is unknown is left to the caller. There is no
  /// reach_farther() after this.
  std::optional<std::size_t> first_blocked_leg(const Costmap& costmap, std::span<const Vector2> route_map);

  /// How far it is from `start` to everywhere, over known ground, and no farther than `most_m`. Good until
  /// the next call.
  const RouteLengths& reach(const Costmap& costmap, const Vector2& start_map,
                            double most_m = std::numeric_limits<double>::infinity());
  /// Goes on from where the last reach() ended: what it gave is good still, and holds more. REQUIRES: that
  /// was the last call but for this one, and its costmap lives and is as it was.
  const RouteLengths& reach_farther(double most_m);

 private:
  /// What a search came to.
  struct Found {
    std::size_t end = 0;          ///< the coarse cell to go to, or that nearest to the goal
    std::optional<Vector2> last;  ///< where the route ends, when near enough to the goal
    bool exactly = false;         ///< at the goal itself
    bool gave_up = false;         ///< the work was too much
  };
  Ground cells(Unknown unknown) const { return {config_, robot_radius_m_ + config_.margin_m, unknown}; }
  Ground legs(Unknown unknown) const { return {config_, robot_radius_m_ + config_.prune_margin_m, unknown}; }
  std::optional<std::vector<Vector2>> into_the_open(const Costmap& costmap, const Ground& cells,
                                                    const Ground& legs, const Vector2& start,
                                                    const std::optional<Vector2>& goal);
  bool is_pocket(const Costmap& costmap, const Ground& cells, const Ground& legs, std::size_t from,
                 std::vector<std::size_t>* pockets);
  Found search(const Costmap& costmap, const Ground& cells, const Ground& legs, const Vector2& from,
               const Vector2& goal);
  std::optional<std::size_t> what_shuts(const Costmap& costmap, const PlanRequest& request) const;
  Vector2 before(const Costmap& costmap, const Vector2& start, std::size_t door) const;
  std::vector<Vector2> centres_to(const Costmap& costmap, std::size_t end) const;

  PlannerConfig config_;
  double robot_radius_m_;
  CoarseSearch search_;
  RouteLengths lengths_;
  std::optional<Ground> wave_cells_, wave_legs_;  ///< of reach()
  double wave_first_m_ = 0.0;                     ///< the way into the open
  int wave_expansions_ = 0;
};

}  // namespace dynslam
