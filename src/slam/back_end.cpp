// SPDX-License-Identifier: MIT
#include "slam/back_end.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "slam/clean_up.h"

namespace dynslam {
namespace {

// The odometry between two local maps is a single match of a scan, whose errors of neighbouring beams go
// together, on a map that is itself a little bent.
constexpr double kMatchInflation = 4.0;
constexpr double kBend_m = 0.004;
constexpr double kBend_rad = 0.0015;
constexpr double kDrift = 0.006;        ///< of the way from one origin to the next
constexpr double kDrift_radpm = 0.002;  ///< for each metre of it
/// A robot that was lost and carried about: where the IMU turned with it, that says how it is turned.
constexpr double kLostWithImu_rad = 0.1;
/// While the robot is lost nothing is forgotten that it might be found by, up to so many maps.
constexpr std::uint32_t kMostLost = 100;

// The IMU's heading from one map to the next.
constexpr double kTurn_rad = 0.01;
constexpr double kTurnDrift_radps = 0.0005;

constexpr std::size_t kBlocksATurn = 60;

}  // namespace

BackEnd::BackEnd(const SlamConfig& config) : loops_(graph_), global_map_(config.cell_size_m) {}

void BackEnd::finish(const LocalMap& map) {
  drop_preview();
  const FinishedMap cleaned = clean_up(map, map.id, map.ended);
  // A copy takes no more than it needs, and does not lie in the midst of what the cleaning took.
  const auto finished = std::make_shared<const FinishedMap>(cleaned);
  add_node(map);
  last_heading_rad_ = map.imu_heading_rad;
  maps_[map.id] = finished;
  const bool closed = loops_.close(finished);
  global_map_.place(finished, graph_.pose(map.id));
  if (closed) settle();
  global_map_.redraw(kBlocksATurn);
  retire_unneeded(map.id);
}

void BackEnd::distrust_imu() {
  graph_.remove_turn_edges();
  last_heading_rad_.reset();
}

void BackEnd::preview(const std::shared_ptr<const FinishedMap>& so_far) {
  drop_preview();
  global_map_.redraw(std::numeric_limits<std::size_t>::max());  // names are only taken out without it
  global_map_.place_for_now(so_far, map_T_drawn(so_far->id) * so_far->drawn_T_origin);
  preview_ = so_far->id;
}

void BackEnd::drop_preview() {
  if (preview_) global_map_.remove(*preview_);
  preview_.reset();
}

std::vector<DrawnChunk> BackEnd::draw() {
  global_map_.redraw(std::numeric_limits<std::size_t>::max());
  return global_map_.publish();
}

bool BackEnd::knows_since(std::uint32_t local_map_id) const {
  const auto after = maps_.lower_bound(local_map_id);
  if (after == maps_.end()) return false;
  if (after == maps_.begin()) return true;  // there is nothing before that could be known again
  const auto tie = graph_.relative_covariance(std::prev(after)->first, maps_.rbegin()->first);
  return tie && !is_anyones_guess(*tie);
}

/// Where a robot that was lost began a map: the IMU, where there is one, turned with it.
Eigen::Matrix3d BackEnd::lost_covariance(const LocalMap& map) const {
  Eigen::Matrix3d covariance = map.origin_covariance;
  if (map.imu_heading_rad && last_heading_rad_)
    covariance(2, 2) = std::min(covariance(2, 2), kLostWithImu_rad * kLostWithImu_rad);
  return covariance;
}

/// Puts a map where the newest finished one says the drawn frame lies, and ties it to the one before.
void BackEnd::add_node(const LocalMap& map) {
  const Pose2 map_T_drawn_now = map_T_drawn(map.id);
  if (maps_.empty()) {
    graph_.add_node(map.id, map_T_drawn_now * map.map_T_origin);
    return;
  }
  const auto& [before, last] = *maps_.rbegin();
  const Pose2 before_T_this = last->drawn_T_origin.inverse() * map.map_T_origin;
  graph_.add_node(map.id, map_T_drawn_now * map.map_T_origin);
  const double between_m = before_T_this.translation().norm();
  const Eigen::Matrix3d covariance =
      map.is_tied
          ? Eigen::Matrix3d(kMatchInflation * turned(map.origin_covariance, -last->drawn_T_origin.yaw) +
                            spread(kBend_m + kDrift * between_m, kBend_rad + kDrift_radpm * between_m))
          : lost_covariance(map);
  if (!map.is_tied && !lost_since_) lost_since_ = map.id;
  graph_.add_odometry_edge(before, map.id, before_T_this, covariance);
  add_turn(before, map);
}

/// What the IMU says of the turn from map to map: it drifts, but it does not slip.
void BackEnd::add_turn(std::uint32_t before, const LocalMap& map) {
  if (map.imu_heading_rad && last_heading_rad_) {
    const double seconds = std::abs(to_seconds(map.begun - maps_.at(before)->begun));
    graph_.add_turn_edge(before, map.id, *map.imu_heading_rad - *last_heading_rad_,
                         kTurn_rad + kTurnDrift_radps * seconds);
  }
}

void BackEnd::settle() {
  const PoseGraphSummary summary = graph_.solve();
  if (!summary.solved) counters_.add("graph.not_solved");
  loops_.note_let_go(summary.let_go);
  std::map<std::uint32_t, Pose2> poses;
  for (const GraphNode& node : graph_.nodes()) poses[node.id] = node.map_T_node;
  global_map_.move(poses);
}

void BackEnd::retire_unneeded(std::uint32_t newest) {
  constexpr std::uint32_t kKept = 4;
  if (newest < kKept) return;
  if (lost_since_ && knows_since(*lost_since_)) lost_since_.reset();
  if (lost_since_ && newest - *lost_since_ < kMostLost) return;
  for (const std::uint32_t id : global_map_.retire(newest - kKept)) {
    const Pose2 origin = graph_.pose(id);
    const auto after = maps_.upper_bound(id);
    const std::uint32_t anchor = after->first;  // the newest is never retired
    retired_[id] = {anchor, graph_.pose(anchor).inverse() * origin, maps_.at(id)->drawn_T_origin};
    graph_.retire(id);
    loops_.forget(id);
    maps_.erase(id);
  }
}

/// A map was taken over by a newer one each time, so that the way from those that stay leads over none that
/// goes.
void BackEnd::forget_retired_before(std::uint32_t id) {
  retired_.erase(retired_.begin(), retired_.lower_bound(id));
  loops_.forget_refused_before(id);
}

Counters BackEnd::counters() const {
  Counters all = counters_;
  for (const auto& [name, n] : loops_.counters()) all.add(name, n);
  return all;
}

std::vector<std::uint32_t> BackEnd::retired() const {
  std::vector<std::uint32_t> ids;
  ids.reserve(retired_.size());
  for (const auto& [id, anchor] : retired_) ids.push_back(id);
  return ids;
}

Pose2 BackEnd::map_T_origin(std::uint32_t id) const {
  Pose2 anchor_T_origin;
  for (auto it = retired_.find(id); it != retired_.end(); it = retired_.find(id)) {
    anchor_T_origin = it->second.anchor_T_origin * anchor_T_origin;
    id = it->second.id;
  }
  return graph_.pose(id) * anchor_T_origin;
}

Pose2 BackEnd::map_T_drawn(std::uint32_t local_map_id) const {
  if (maps_.empty()) return {};
  const auto gone = retired_.find(local_map_id);
  if (gone != retired_.end()) return map_T_origin(local_map_id) * gone->second.drawn_T_origin.inverse();
  const auto it = maps_.find(local_map_id);
  const auto& [id, finished] = it != maps_.end() ? *it : *maps_.rbegin();
  return graph_.has(id) ? graph_.pose(id) * finished->drawn_T_origin.inverse() : Pose2{};
}

}  // namespace dynslam
