// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "autopilot/exploration_config.h"
#include "autopilot/frontier.h"
#include "autopilot/tried_places.h"
#include "autopilot/visit_map.h"
#include "grid/chunked_grid.h"

namespace dynslam {

/// In the order of what they are worth.
enum class PlaceKind { kFrontier, kUnvisited, kOld };

/// A place of interest: something to be seen, and where to see it from.
struct Place {
  PlaceKind kind = PlaceKind::kFrontier;
  Vector2 point_map;         ///< what is to be seen
  Vector2 stand_map;         ///< where to see it from; there is a route
  double route_m = 0.0;      ///< how long it is
  double gain = 0.0;         ///< metres of frontier to be seen
  bool is_shut_off = false;  ///< seen once, but there is no way to it: a door may open
  int tries = 0;             ///< in vain
};

/// What exploring asks of a planner.
struct Reachability {
  /// The length of the route to a point; none: there is no route.
  std::function<std::optional<double>(const Vector2& point_map)> route_m;
  /// Of the points that there is a route to the nearest to a point, from which it is in sight; none: none is
  /// so near.
  std::function<std::optional<Vector2>(const Vector2& point_map, double within_m)> nearest;
  /// Before what shuts the way that there was to a point once: where to see whether a door has opened.
  std::function<std::optional<Vector2>(const Vector2& point_map)> before_door = [](const Vector2&) {
    return std::optional<Vector2>();
  };
  /// Only routes up to this length were looked for.
  std::function<double()> looked_m = [] { return std::numeric_limits<double>::infinity(); };
  /// Looks for longer ones; false: that was everything.
  std::function<bool()> look_farther = [] { return false; };
  /// Whether there may be something in the way there that is not seen.
  std::function<bool(const Vector2& point_map)> is_risky = [](const Vector2&) { return false; };
};

/// What lies behind a narrower gap than a door is no room.
inline constexpr double kDoor_m = 0.6;

/// Frontiers that the last choice left out.
struct LeftOut {
  std::size_t waiting = 0;       ///< tried in vain, to be tried again
  std::size_t given_up = 0;      ///< tried in vain too often
  std::size_t out_of_reach = 0;  ///< no route to where it would be seen
  std::size_t cut_off = 0;       ///< of these as wide as a door, where there never was a route
  std::optional<Time> next;      ///< when the first of those that had no route may be tried again
};

/// Chooses where to go next to learn the most (thesis 6.6): to frontiers first, then to history cells where
/// the robot never was, then to those where it was longest ago. What was tried in vain is left alone for a
/// while, then comes after what is new; frontiers that stay after `most_tries` are given up, small ones after
/// one look from near, so that what cannot be seen does not attract for ever. Pure; one thread.
class Exploration {
 public:
  explicit Exploration(const ExplorationConfig& config = {})
      : config_(config), frontiers_(config.same_place_m), cells_(config.same_place_m) {}

  /// To be called once a second or so: frontiers that come and go do not count.
  /// `once`: what was tried in vain is not tried again.
  /// Places of the most worthy kind of which there are any, best first; none for a robot that is nowhere.
  /// Frontiers: the way, less what is to be seen there; the one that was first the last time stays first
  /// unless another is clearly better. Cells never visited: the nearest few. Old ones: the oldest few.
  std::vector<Place> places(Time now, const Vector2& robot_map, std::span<const Frontier> frontiers,
                            const VisitMap& visits, const GridSnapshot& map, const Reachability& reach,
                            bool once = false);

  /// There was no way to it, whatever the planner said.
  void failed(Time now, const Place& place);
  /// The robot stands there. What is still a place of interest after that was tried in vain.
  void reached(Time now, const Place& place);

  /// It was seen from afar, and is a place of interest no more.
  void vanished(Time now, const Place& place);

  /// Hardly anything is to be seen there.
  bool is_nook(const Frontier& f) const {
    return f.is_short || f.extent_m < kDoor_m || f.beyond_m2 < config_.nook_m2;
  }

  /// It was looked at from near, and stayed what it was.
  bool was_looked_at(const Vector2& frontier_map) const;

  /// As of the last call of places(). Exploring is over when there is no place and `next` is none.
  const LeftOut& left_out() const { return left_out_; }

 private:
  /// The lower, the better.
  struct Ranked {
    double rank;
    Place place;
  };
  std::vector<Ranked> frontier_places(Time now, std::span<const Frontier> frontiers,
                                      const Reachability& reach);
  std::vector<Ranked> frontiers_reached(Time now, std::span<const Frontier> frontiers,
                                        const Reachability& reach);
  std::vector<Ranked> unvisited_places(Time now, const Vector2& robot_map, const VisitMap& visits,
                                       const GridSnapshot& map, const Reachability& reach) const;
  std::vector<Ranked> old_places(Time now, const VisitMap& visits, const Reachability& reach) const;
  void see(Time now, std::span<const Frontier> frontiers);
  bool counts(Time now, const Vector2& middle_map) const;
  double worth_m(const Frontier& f) const;
  bool is_left_alone(Time now, const Frontier& frontier, bool is_shut_off);
  void stay_with_chosen(std::vector<Ranked>& found) const;

  ExplorationConfig config_;
  TriedPlaces frontiers_, cells_;
  struct Seen {
    Vector2 middle_map;
    Time since;
    bool is_worth_it;
  };
  std::vector<Seen> seen_;  ///< the frontiers there are
  bool once_ = false;
  std::optional<Place> chosen_;
  LeftOut left_out_;
};

}  // namespace dynslam
