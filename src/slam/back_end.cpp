// SPDX-License-Identifier: MIT
#include "slam/back_end.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/LU>

#include "slam/clean_up.h"

namespace dynslam {
namespace {

/// Maps that follow each other share scans: what they agree on says nothing new.
constexpr std::uint32_t kNeighbours = 2;
constexpr std::size_t kMostCandidates = 4;
constexpr std::size_t kLookPoints = 100;  ///< of a map, to see how much of it another may know
constexpr double kLeastShare = 0.3;

// The odometry between two local maps is a single match of a scan, whose errors of neighbouring beams go
// together, on a map that is itself a little bent.
constexpr double kMatchInflation = 4.0;
constexpr double kBend_m = 0.004;
constexpr double kBend_rad = 0.0015;
/// A map begun without a match to the one before is somewhere near.
constexpr double kLost_m = 2.0;
constexpr double kLost_rad = 0.5;

/// The same for closures: their fit knows nothing of how the maps themselves are bent.
constexpr double kClosureInflation = 4.0;
constexpr double kClosureBend_m = 0.008;
constexpr double kClosureBend_rad = 0.002;

constexpr double kWindowSigmas = 3.0;

constexpr std::size_t kBlocksATurn = 400;

Eigen::Matrix3d spread(double xy_m, double yaw_rad) {
  return Eigen::Vector3d(xy_m * xy_m, xy_m * xy_m, yaw_rad * yaw_rad).asDiagonal();
}

/// A covariance given along the axes of a pose's yaw, along those of the frame around it.
Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance, double yaw) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(yaw), -std::sin(yaw), std::sin(yaw), std::cos(yaw);
  return turn * covariance * turn.transpose();
}

/// Whether a map knows anything within two cells: a wall is drawn thin, and rarely twice in the same place.
bool is_known_around(const FinishedMap& map, CellIndex cell) {
  std::uint64_t any = 0;
  for (int dy = -2; dy <= 2; dy += 2) {
    const CellIndex first{cell.x - 2, cell.y + dy};
    any |= map.free.word(first) | map.occupied.word(first);
  }
  return (any & 0x1F) != 0;
}

/// Share of points, given in a frame at `origin_T_points`, of which a map knows something.
double share_known(const FinishedMap& map, const Pose2& origin_T_points, const std::vector<Vector2>& points) {
  const Pose2 drawn_T_points = map.drawn_T_origin * origin_T_points;
  int known = 0;
  for (const Vector2& p : points)
    known += is_known_around(map, cell_at(drawn_T_points * p, map.cell_size_m)) ? 1 : 0;
  return static_cast<double>(known) / static_cast<double>(points.size());
}

SearchWindow window_for(const Eigen::Matrix3d& covariance) {
  SearchWindow window;
  window.half_x_m = std::clamp(kWindowSigmas * std::sqrt(covariance(0, 0)), 0.15, 4.0);
  window.half_y_m = std::clamp(kWindowSigmas * std::sqrt(covariance(1, 1)), 0.15, 4.0);
  window.half_yaw_rad = std::clamp(kWindowSigmas * std::sqrt(covariance(2, 2)), radians(2), radians(20));
  return window;
}

}  // namespace

BackEnd::BackEnd(const SlamConfig& config)
    : config_(config), global_map_(config.cell_size_m) {}

void BackEnd::finish(const LocalMap& map) {
  auto finished = std::make_shared<const FinishedMap>(clean_up(map, map.id, map.ended));
  add_node(map);
  Finished& entry = maps_[map.id];
  entry.map = finished;
  for (const CloudPoint& p : finished->cloud)
    entry.reach_m = std::max<double>(entry.reach_m, std::hypot(p.x_m, p.y_m));
  const bool closed = search_loops(*finished);
  global_map_.place(finished, graph_.pose(map.id));
  if (closed) settle();
  global_map_.redraw(kBlocksATurn);
  retire_unneeded(map.id);
}

/// Puts a map where the newest finished one says the drawn frame lies, and ties it to the one before.
void BackEnd::add_node(const LocalMap& map) {
  const Pose2 map_T_drawn_now = map_T_drawn(map.id);
  if (maps_.empty()) {
    graph_.add_node(map.id, map_T_drawn_now * map.map_T_origin);
    return;
  }
  const auto& [before, last] = *maps_.rbegin();
  const Pose2 before_T_this = last.map->drawn_T_origin.inverse() * map.map_T_origin;
  graph_.add_node(map.id, map_T_drawn_now * map.map_T_origin);
  const Eigen::Matrix3d covariance =
      map.is_tied ? Eigen::Matrix3d(kMatchInflation *
                                        turned(map.origin_covariance, -last.map->drawn_T_origin.yaw) +
                                    spread(kBend_m, kBend_rad))
                  : spread(kLost_m, kLost_rad);
  graph_.add_odometry_edge(before, map.id, before_T_this, covariance);
}

bool BackEnd::search_loops(const FinishedMap& source) {
  bool any = false;
  for (const Candidate& candidate : candidates(source)) any = try_loop(source, candidate) || any;
  return any;
}

/// Maps that may show the same place, those first whose place relative to this one is least known for what
/// they share.
std::vector<BackEnd::Candidate> BackEnd::candidates(const FinishedMap& source) const {
  std::vector<Candidate> found;
  const std::vector<Vector2> points = thin_out(source.cloud, kLookPoints, 0.1);
  if (points.empty()) return found;
  const double reach_m = maps_.at(source.id).reach_m;
  const auto relatives = graph_.relatives_of(source.id);
  for (const auto& [id, other] : maps_) {
    if (id + kNeighbours > source.id || !relatives.contains(id)) continue;
    const Pose2 guess = graph_.pose(id).inverse() * graph_.pose(source.id);
    const RelativePose measured = inverse(relatives.at(id));
    const double unsure_m = std::sqrt(measured.covariance(0, 0) + measured.covariance(1, 1));
    if (guess.translation().norm() > reach_m + other.reach_m + unsure_m) continue;
    const double share = share_known(*other.map, guess, points);
    if (share < kLeastShare && unsure_m < 1.0) continue;
    found.push_back({id, {guess, measured.covariance}, std::max(share, 0.1) * (0.01 + unsure_m)});
  }
  const auto keep = found.begin() + static_cast<std::ptrdiff_t>(std::min(found.size(), kMostCandidates));
  std::partial_sort(found.begin(), keep, found.end(),
                    [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
  found.erase(keep, found.end());
  return found;
}

bool BackEnd::try_loop(const FinishedMap& source, const Candidate& candidate) {
  const Finished& target = maps_.at(candidate.id);
  const SearchWindow window =
      window_for(turned(candidate.target_T_source.covariance, target.map->drawn_T_origin.yaw));
  const LoopMatch match =
      find_loop(MaxPyramid(*target.map), *target.map, source, candidate.target_T_source.pose, window);
  counters_.add("loops.searched");
  if (const auto why = refusal(match)) {
    counters_.add("loops.refused." + std::string(*why));
    return false;
  }
  const RelativePose closure{match.target_T_source,
                             kClosureInflation * Eigen::Matrix3d(match.information.inverse()) +
                                 spread(kClosureBend_m, kClosureBend_rad)};
  const RelativePose both{closure.pose, closure.covariance + candidate.target_T_source.covariance};
  constexpr double kGate = 25.0;
  if (mahalanobis2(both, candidate.target_T_source.pose) > kGate) {
    counters_.add("loops.refused.inconsistent");
    return false;
  }
  if (!graph_.add_loop_edge(candidate.id, source.id, closure.pose, closure.covariance)) return false;
  ++closures_;
  return true;
}

void BackEnd::settle() {
  const PoseGraphSummary summary = graph_.solve();
  if (!summary.solved) counters_.add("graph.not_solved");
  if (!summary.let_go.empty()) counters_.add("loops.let_go", summary.let_go.size());
  std::map<std::uint32_t, Pose2> poses;
  for (const GraphNode& node : graph_.nodes()) poses[node.id] = node.map_T_node;
  global_map_.move(poses);
}

void BackEnd::retire_unneeded(std::uint32_t newest) {
  constexpr std::uint32_t kKept = 4;
  if (newest < kKept) return;
  for (const std::uint32_t id : global_map_.retire(newest - kKept)) {
    const Pose2 origin = graph_.pose(id);
    const auto after = maps_.upper_bound(id);
    const std::uint32_t anchor = after->first;  // the newest is never retired
    retired_[id] = {anchor, graph_.pose(anchor).inverse() * origin, maps_.at(id).map->drawn_T_origin};
    graph_.retire(id);
    maps_.erase(id);
  }
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
  return graph_.has(id) ? graph_.pose(id) * finished.map->drawn_T_origin.inverse() : Pose2{};
}

}  // namespace dynslam
