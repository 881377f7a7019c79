// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "base/pose2.h"
#include "slam/relative_pose.h"

namespace dynslam {

struct PoseGraphConfig {
  /// Scale of the Cauchy loss on loop edges, standard deviations. A lone loop is pulled in if it lies less
  /// than about twice this far out, as measured by what the rest of the graph allows.
  double loop_loss_sigmas = 3.0;
  double let_go_sigmas = 5.0;   ///< loops this far off after solving are removed (5: 1 in 65 000 by chance)
  int max_rounds = 10;          ///< most times that loops are let go and the rest solved again
  int max_iterations = 50;      ///< of the solver, each time
  int max_loops_per_node = 16;  ///< a node that inherits more from retired ones keeps the surest
};

enum class EdgeKind : std::uint8_t {
  kOdometry,  ///< from one local map to the next: always believed
  kLoop,      ///< found by search: may be wrong
  kTurn       ///< the IMU's: yaw alone
};

struct GraphNode {
  std::uint32_t id = 0;
  Pose2 map_T_node;
};

struct GraphEdge {
  EdgeKind kind = EdgeKind::kOdometry;
  std::uint32_t a = 0, b = 0;  ///< a < b
  double residual = 0.0;       ///< standard deviations off at the present poses
  Pose2 a_T_b;                 ///< as measured; of a turn yaw alone
};

struct PoseGraphSummary {
  bool solved = true;             ///< false: the solver gave up, and the poses are as they were
  int iterations = 0;             ///< of all rounds together
  double cost_before = 0.0;       ///< half the sum of squares, loops as their loss counts them
  double cost_after = 0.0;        ///< without the loops let go
  std::vector<GraphEdge> let_go;  ///< loops removed this time
};

/// Where the local maps lie in the building: poses, and what was measured between them, solved for the most
/// likely poses (SE(2), Levenberg-Marquardt).
///
/// The oldest node (ids count up) stays where it is; so does the oldest of each part that nothing ties to the
/// rest. There is at most one edge of each kind between two nodes: of more, the surest counts. Loops have a
/// Cauchy loss: one that contradicts the others pulls the less the farther off it is, so that it stands out
/// and is let go instead of bending the map (Huber's would pull a lone wrong loop shut however much odometry
/// is against it). The same calls give the same bits. One thread.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphConfig& config = {}) : config_(config) {}

  /// The add_ functions return false, change nothing and count in refused() when a node is unknown (or, for
  /// add_node, known), an edge leads back to its own node, or a value is not finite. Covariances must be
  /// positive definite: m2, m rad, rad2, axes of a.
  bool add_node(std::uint32_t id, const Pose2& map_T_node);
  bool add_odometry_edge(std::uint32_t a, std::uint32_t b, const Pose2& a_T_b,
                         const Eigen::Matrix3d& covariance);
  bool add_loop_edge(std::uint32_t a, std::uint32_t b, const Pose2& a_T_b, const Eigen::Matrix3d& covariance);
  /// What the IMU says of the turn from a to b: a weak prior, as it drifts.
  bool add_turn_edge(std::uint32_t a, std::uint32_t b, double yaw_a_to_b_rad, double sigma_rad);

  /// Takes all that the IMU said back.
  void remove_turn_edges();

  /// Solves from the present poses; lets go the loops that stay far off, the farthest first, and solves
  /// again.
  PoseGraphSummary solve();

  /// Takes a node out. All it was tied to is tied to its surest neighbour instead, by composition, so that
  /// what was connected stays so. False: there is no such node.
  bool retire(std::uint32_t id);

  bool has(std::uint32_t id) const { return nodes_.contains(id); }
  /// map_T_node. REQUIRES: has(id).
  const Pose2& pose(std::uint32_t id) const { return nodes_.at(id); }
  std::vector<GraphNode> nodes() const;
  std::vector<GraphEdge> edges() const;

  /// How well the pose of b in a is known, from above: along the surest chain of edges. Nothing when there is
  /// no chain.
  std::optional<Eigen::Matrix3d> relative_covariance(std::uint32_t a, std::uint32_t b) const;
  /// The same from one node to all that it is tied to, at the price of one. `pose` is what the measurements
  /// along the chain add up to.
  std::map<std::uint32_t, RelativePose> relatives_of(std::uint32_t a) const { return chains_from(a, true); }

  std::uint64_t refused() const { return refused_; }
  std::uint64_t loops_let_go() const { return loops_let_go_; }

 private:
  struct EdgeKey {
    std::uint32_t a, b;  ///< a < b
    EdgeKind kind;
    auto operator<=>(const EdgeKey&) const = default;
  };
  struct Edge {
    RelativePose a_T_b;         ///< of a turn edge only yaw is filled
    Eigen::Matrix3d whitening;  ///< W with W^T W = covariance^-1
  };
  struct Spoke {  ///< an edge as seen from one of its nodes
    std::uint32_t other;
    EdgeKind kind;
    RelativePose node_T_other;
  };
  using Edges = std::map<EdgeKey, Edge>;

  static std::optional<Edge> make_edge(EdgeKind kind, const RelativePose& a_T_b);
  bool add_edge(EdgeKind kind, std::uint32_t a, std::uint32_t b, const RelativePose& a_T_b);
  double residual(const EdgeKey& key, const Edge& edge) const;
  std::vector<Spoke> take_spokes(std::uint32_t id);
  void hand_over(const std::vector<Spoke>& spokes, const Spoke& link);
  void thin_loops(std::uint32_t id);
  std::map<std::uint32_t, RelativePose> chains_from(std::uint32_t start, bool with_loops) const;
  std::vector<std::uint32_t> oldest_of_each_part() const;
  bool solve_once(PoseGraphSummary& summary);
  bool let_go_farthest(PoseGraphSummary& summary);

  PoseGraphConfig config_;
  std::map<std::uint32_t, Pose2> nodes_;  ///< map_T_node
  Edges edges_;
  std::uint64_t refused_ = 0;
  std::uint64_t loops_let_go_ = 0;
};

}  // namespace dynslam
