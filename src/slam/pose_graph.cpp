// SPDX-License-Identifier: MIT
#include "slam/pose_graph.h"

#include <algorithm>
#include <set>
#include <utility>

#include <Eigen/Cholesky>

namespace dynslam {

bool PoseGraph::add_node(std::uint32_t id, const Pose2& map_T_node) {
  const bool good = is_finite(map_T_node) && nodes_.try_emplace(id, map_T_node).second;
  if (!good) ++refused_;
  return good;
}

bool PoseGraph::add_odometry_edge(std::uint32_t a, std::uint32_t b, const Pose2& a_T_b,
                                  const Eigen::Matrix3d& covariance) {
  return add_edge(EdgeKind::kOdometry, a, b, {a_T_b, covariance});
}

bool PoseGraph::add_loop_edge(std::uint32_t a, std::uint32_t b, const Pose2& a_T_b,
                              const Eigen::Matrix3d& covariance) {
  return add_edge(EdgeKind::kLoop, a, b, {a_T_b, covariance});
}

bool PoseGraph::add_turn_edge(std::uint32_t a, std::uint32_t b, double yaw_a_to_b_rad, double sigma_rad) {
  RelativePose a_T_b{{0, 0, yaw_a_to_b_rad}, Eigen::Matrix3d::Zero()};
  a_T_b.covariance(2, 2) = sigma_rad * sigma_rad;
  return add_edge(EdgeKind::kTurn, a, b, a_T_b);
}

std::optional<PoseGraph::Edge> PoseGraph::make_edge(EdgeKind kind, const RelativePose& a_T_b) {
  if (!is_finite(a_T_b.pose) || !a_T_b.covariance.allFinite()) return std::nullopt;
  Edge edge{{a_T_b.pose, 0.5 * (a_T_b.covariance + a_T_b.covariance.transpose())}, Eigen::Matrix3d::Zero()};
  if (kind == EdgeKind::kTurn) {
    const double variance = a_T_b.covariance(2, 2);
    edge.a_T_b = {{0, 0, a_T_b.pose.yaw}, Eigen::Vector3d(0, 0, variance).asDiagonal()};
    if (!(variance > 0)) return std::nullopt;
    edge.whitening(2, 2) = 1 / std::sqrt(variance);
  } else {
    const Eigen::LLT<Eigen::Matrix3d> root(edge.a_T_b.covariance);
    if (root.info() != Eigen::Success) return std::nullopt;
    edge.whitening = root.matrixL().solve(Eigen::Matrix3d::Identity());
  }
  if (!edge.whitening.allFinite()) return std::nullopt;
  return edge;
}

bool PoseGraph::add_edge(EdgeKind kind, std::uint32_t a, std::uint32_t b, const RelativePose& a_T_b) {
  if (a > b) return add_edge(kind, b, a, inverse(a_T_b));
  const auto edge = make_edge(kind, a_T_b);
  if (a == b || !has(a) || !has(b) || !edge) {
    ++refused_;
    return false;
  }
  const auto [there, added] = edges_.try_emplace({a, b, kind}, *edge);
  // Two looks at one pair of maps see the same walls: the second says little new, and counting both would
  // make the pair too sure of itself.
  if (!added && edge->a_T_b.covariance.trace() < there->second.a_T_b.covariance.trace())
    there->second = *edge;
  return true;
}

double PoseGraph::residual(const EdgeKey& key, const Edge& edge) const {
  const Pose2 a_T_b = pose(key.a).inverse() * pose(key.b);
  const Pose2& measured = edge.a_T_b.pose;
  const Eigen::Vector3d off(a_T_b.x - measured.x, a_T_b.y - measured.y, turn(measured.yaw, a_T_b.yaw));
  return (edge.whitening * off).norm();
}

std::vector<GraphNode> PoseGraph::nodes() const {
  std::vector<GraphNode> all;
  all.reserve(nodes_.size());
  for (const auto& [id, map_T_node] : nodes_) all.push_back({id, map_T_node});
  return all;
}

std::vector<GraphEdge> PoseGraph::edges() const {
  std::vector<GraphEdge> all;
  all.reserve(edges_.size());
  for (const auto& [key, edge] : edges_)
    all.push_back({key.kind, key.a, key.b, residual(key, edge), edge.a_T_b.pose});
  return all;
}

bool PoseGraph::retire(std::uint32_t id) {
  if (nodes_.erase(id) == 0) return false;
  const std::vector<Spoke> spokes = take_spokes(id);
  // Odometry before loops, then the surest. Turns tie no positions.
  const auto worth = [](const Spoke& s) { return std::pair(s.kind, s.node_T_other.covariance.trace()); };
  const auto link = std::min_element(spokes.begin(), spokes.end(),
                                     [&](const Spoke& a, const Spoke& b) { return worth(a) < worth(b); });
  if (link != spokes.end() && link->kind != EdgeKind::kTurn) hand_over(spokes, *link);
  return true;
}

std::vector<PoseGraph::Spoke> PoseGraph::take_spokes(std::uint32_t id) {
  std::vector<Spoke> spokes;
  std::erase_if(edges_, [&](const Edges::value_type& item) {
    const auto& [key, edge] = item;
    if (key.a == id) spokes.push_back({key.b, key.kind, edge.a_T_b});
    if (key.b == id) spokes.push_back({key.a, key.kind, inverse(edge.a_T_b)});
    return key.a == id || key.b == id;
  });
  return spokes;
}

void PoseGraph::hand_over(const std::vector<Spoke>& spokes, const Spoke& link) {
  const auto turn_link = std::find_if(spokes.begin(), spokes.end(), [&](const Spoke& s) {
    return s.other == link.other && s.kind == EdgeKind::kTurn;
  });
  for (const Spoke& s : spokes) {
    if (s.other == link.other) continue;
    const bool by_imu = s.kind == EdgeKind::kTurn && turn_link != spokes.end();
    const RelativePose heir_T_node = inverse(by_imu ? turn_link->node_T_other : link.node_T_other);
    add_edge(s.kind, link.other, s.other, heir_T_node * s.node_T_other);
  }
  thin_loops(link.other);
}

void PoseGraph::thin_loops(std::uint32_t id) {
  std::vector<std::pair<double, EdgeKey>> loops;
  for (const auto& [key, edge] : edges_) {
    if (key.kind == EdgeKind::kLoop && (key.a == id || key.b == id))
      loops.emplace_back(edge.a_T_b.covariance.trace(), key);
  }
  const auto most = static_cast<std::size_t>(std::max(config_.max_loops_per_node, 1));
  if (loops.size() <= most) return;
  std::sort(loops.begin(), loops.end());
  // A loop may be all that holds two parts together.
  const auto by_odometry = chains_from(id, false);
  for (std::size_t i = most; i < loops.size(); ++i) {
    const EdgeKey& key = loops[i].second;
    if (by_odometry.contains(key.a) && by_odometry.contains(key.b)) edges_.erase(key);
  }
}

std::map<std::uint32_t, RelativePose> PoseGraph::chains_from(std::uint32_t start, bool with_loops) const {
  std::map<std::uint32_t, RelativePose> settled;
  if (!has(start)) return settled;
  std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, const Edge*>>> adjacent;
  for (const auto& [key, edge] : edges_) {
    if (key.kind == EdgeKind::kTurn || (key.kind == EdgeKind::kLoop && !with_loops)) continue;
    adjacent[key.a].emplace_back(key.b, &edge);
    adjacent[key.b].emplace_back(key.a, &edge);
  }
  // Dijkstra. An edge is as long as its trace: a radian counts like a metre.
  struct Reached {
    double length;
    RelativePose start_T_node;
  };
  std::map<std::uint32_t, Reached> reached{{start, {0.0, {}}}};
  std::set<std::pair<double, std::uint32_t>> open{{0.0, start}};
  while (!open.empty()) {
    const std::uint32_t here = open.extract(open.begin()).value().second;
    const Reached at = reached.at(here);
    settled.emplace(here, at.start_T_node);
    for (const auto& [next, edge] : adjacent[here]) {
      const double length = at.length + edge->a_T_b.covariance.trace();
      const auto known = reached.find(next);
      if (known != reached.end() && known->second.length <= length) continue;
      if (known != reached.end()) open.erase({known->second.length, next});
      open.emplace(length, next);
      reached[next] = {length, at.start_T_node * (here < next ? edge->a_T_b : inverse(edge->a_T_b))};
    }
  }
  return settled;
}

std::optional<Eigen::Matrix3d> PoseGraph::relative_covariance(std::uint32_t a, std::uint32_t b) const {
  const auto chains = chains_from(a, true);
  const auto found = chains.find(b);
  return found == chains.end() ? std::nullopt : std::optional(found->second.covariance);
}

void PoseGraph::remove_turn_edges() {
  std::erase_if(edges_, [](const auto& edge) { return edge.first.kind == EdgeKind::kTurn; });
}

}  // namespace dynslam
