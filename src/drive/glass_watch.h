// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "drive/body_config.h"
#include "drive/obstacle_points.h"
#include "drive/segment.h"
#include "drive/sight.h"

namespace dynslam {

/// Beams go through glass unless they meet it squarely: of a pane a lidar sees a small patch, straight across
/// from where it is, which wanders along the pane just as the robot moves along it. A post stays where it is,
/// what is round lags behind, who walks goes his own way. A pane is taken to go on beside the patch for as
/// far as the robot's corners reach. One thread.
class GlassWatch {
 public:
  explicit GlassWatch(double blind_m) : blind_m_(blind_m) {}

  /// `points`: of the scan, in the order of its beams, from the robot.
  void see(std::span<const ObstaclePoint> points, const Look& look);
  /// Adds what is not seen of panes that are near.
  void add_to(std::vector<ObstaclePoint>& points, const BodyConfig& body) const;
  void forget() { tracks_.clear(); }

  /// What was seen squarely of panes that are surely some, or came too near to be seen, from the robot at the
  /// end of that scan.
  std::vector<Segment> panes() const;

 private:
  /// Patches on one line, one after the other.
  struct Track {
    Segment all, patch;
    Time seen;
    double away_m;               ///< from the lidar, then
    Vector2 first, lidar_first;  ///< the middle of the first patch, and where the lidar was then
    std::optional<Time> pane_since;
  };
  void follow(const Segment& patch, Time now);
  double moved_along_m(const Track& track) const;
  bool wanders_as_glass(const Track& track, double tolerance = 1.0) const;
  static bool was_glass_for(const Track& track, Duration least);
  bool is_surely_glass(const Track& track) const;
  bool came_too_near(const Track& track) const;
  /// Since it was seen: longer when it is too near for that.
  Duration kept_for(const Track& track) const;

  double blind_m_;
  Time end_;                         ///< of the last scan
  Vector2 lidar_ = Vector2::Zero();  ///< where it is on the robot
  std::vector<Track> tracks_;
};

}  // namespace dynslam
