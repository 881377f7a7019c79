// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "base/counters.h"
#include "slam/finished_map.h"
#include "slam/global_map.h"
#include "slam/local_map.h"
#include "slam/loop_closer.h"
#include "slam/pose_graph.h"
#include "slam/slam_config.h"

namespace dynslam {

/// From complete local maps to a map of everything (thesis, figure 4.3): cleans each, looks for places seen
/// before, lets the pose graph settle where all of them lie, and draws. Work is counted, never timed; memory
/// depends on the building, not on the hours. One thread.
class BackEnd {
 public:
  explicit BackEnd(const SlamConfig& config);

  /// Takes in the next local map, in order of id.
  void finish(const LocalMap& map);

  /// Takes back what the IMU said: it was found to be wrong.
  void distrust_imu();

  /// Shows what there is of the next one until it is complete.
  void preview(const std::shared_ptr<const FinishedMap>& so_far);
  /// Draws all that changed; returns the chunks that look different from when this was called last.
  std::vector<DrawnChunk> draw();

  /// Whether it is known where the newest local map lies among those from before a given one, after which
  /// the robot was lost.
  bool knows_since(std::uint32_t local_map_id) const;

  /// What is to be put before poses of the front end that were matched against a local map: map_T_drawn. For
  /// one that is not finished yet, that of the newest that is; for one that was retired, by the map that took
  /// its place.
  Pose2 map_T_drawn(std::uint32_t local_map_id) const;

  /// Nobody will ask any more where retired maps older than this one went; loops that were not believed and
  /// speak of them are forgotten, too. Without it memory grows by some 200 bytes a retired map.
  void forget_retired_before(std::uint32_t id);
  /// The pose of a local map's origin, retired or not. REQUIRES: it was finished, and not forgotten.
  Pose2 map_T_origin(std::uint32_t id) const;
  /// The ids of the retired ones, without those forgotten.
  std::vector<std::uint32_t> retired() const;

  const GlobalMap& global_map() const { return global_map_; }
  const PoseGraph& graph() const { return graph_; }
  const LoopCloser& loops() const { return loops_; }
  Counters counters() const;

 private:
  /// Where a retired map went: its origin in that of one that lives, or was retired later.
  struct Anchor {
    std::uint32_t id = 0;
    Pose2 anchor_T_origin;
    Pose2 drawn_T_origin;
  };

  void add_node(const LocalMap& map);
  Eigen::Matrix3d lost_covariance(const LocalMap& map) const;
  void add_turn(std::uint32_t before, const LocalMap& map);
  void drop_preview();
  void settle();
  void retire_unneeded(std::uint32_t newest);

  PoseGraph graph_;
  LoopCloser loops_;
  GlobalMap global_map_;
  std::map<std::uint32_t, std::shared_ptr<const FinishedMap>> maps_;
  std::map<std::uint32_t, Anchor> retired_;
  std::optional<std::uint32_t> preview_;
  std::optional<std::uint32_t> lost_since_;  ///< the first local map of a robot that was lost and not found
  std::optional<double> last_heading_rad_;   ///< the IMU's, when the newest map was begun
  Counters counters_;
};

}  // namespace dynslam
