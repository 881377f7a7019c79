// SPDX-License-Identifier: MIT
// The part of the pose graph that knows Ceres.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "slam/pose_graph.h"
#include "slam/relative_pose_cost.h"

namespace dynslam {
namespace {

using Block = std::array<double, 3>;  ///< x, y, yaw; yaw may leave [-pi, pi] while solving

ceres::Solver::Options solver_options(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Not SuiteSparse: it would sum through whatever BLAS is installed, with threads and bits of its own.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-8;
  options.parameter_tolerance = 1e-8;
  // The usual 1e4 damps the slow bends of a long chain so much that steps grow more with its length.
  options.initial_trust_region_radius = 1e6;
  options.logging_type = ceres::SILENT;
  return options;
}

bool is_finite(const Block& b) {
  return std::all_of(b.begin(), b.end(), [](double v) { return std::isfinite(v); });
}

}  // namespace

PoseGraphSummary PoseGraph::solve() {
  PoseGraphSummary summary;
  const auto before = nodes_;
  for (int round = 0; summary.solved; ++round) {
    summary.solved = solve_once(summary);
    if (!summary.solved) nodes_ = before;
    if (!summary.solved || round == config_.max_rounds || !let_go_farthest(summary)) break;
  }
  return summary;
}

bool PoseGraph::solve_once(PoseGraphSummary& summary) {
  std::map<std::uint32_t, Block> blocks;
  ceres::Problem problem;
  for (const auto& [id, map_T_node] : nodes_) {
    Block& block = blocks[id] = {map_T_node.x, map_T_node.y, map_T_node.yaw};
    problem.AddParameterBlock(block.data(), static_cast<int>(block.size()));
  }
  for (const std::uint32_t id : oldest_of_each_part()) problem.SetParameterBlockConstant(blocks[id].data());
  for (const auto& [key, edge] : edges_) {
    const Pose2& a_T_b = edge.a_T_b.pose;
    ceres::CostFunction* cost = nullptr;  // the problem owns what it is given
    if (key.kind == EdgeKind::kTurn) {
      cost = new TurnCost(a_T_b.yaw, edge.whitening(2, 2));
    } else {
      cost = new RelativePoseCost(a_T_b, edge.whitening);
    }
    ceres::LossFunction* loss =
        key.kind == EdgeKind::kLoop ? new ceres::CauchyLoss(config_.loop_loss_sigmas) : nullptr;
    problem.AddResidualBlock(cost, loss, blocks[key.a].data(), blocks[key.b].data());
  }
  ceres::Solver::Summary solved;
  ceres::Solve(solver_options(config_.max_iterations), &problem, &solved);
  if (!solved.IsSolutionUsable() || !std::isfinite(solved.final_cost)) return false;
  for (const auto& [id, block] : blocks) {
    if (!is_finite(block)) return false;
    nodes_[id] = {block[0], block[1], wrap_angle(block[2])};
  }
  if (summary.iterations == 0) summary.cost_before = solved.initial_cost;
  summary.iterations += static_cast<int>(solved.iterations.size());
  summary.cost_after = solved.final_cost;
  return true;
}

std::vector<std::uint32_t> PoseGraph::oldest_of_each_part() const {
  std::map<std::uint32_t, std::uint32_t> older;  // leads from node to node to the oldest of its part
  for (const auto& [id, _] : nodes_) older[id] = id;
  const auto oldest = [&](std::uint32_t id) {
    while (older[id] != id) id = older[id] = older[older[id]];
    return id;
  };
  for (const auto& [key, edge] : edges_) {
    const auto [first, second] = std::minmax({oldest(key.a), oldest(key.b)});
    if (key.kind != EdgeKind::kTurn) older[second] = first;
  }
  std::vector<std::uint32_t> roots;
  for (const auto& [id, next] : older) {
    if (id == next) roots.push_back(id);
  }
  return roots;
}

bool PoseGraph::let_go_farthest(PoseGraphSummary& summary) {
  std::vector<GraphEdge> far;
  double worst = 0.0;
  for (const auto& [key, edge] : edges_) {
    const double off = residual(key, edge);
    if (key.kind != EdgeKind::kLoop || off <= config_.let_go_sigmas) continue;
    far.push_back({key.kind, key.a, key.b, off, edge.a_T_b.pose});
    worst = std::max(worst, off);
  }
  // The others may only be off because the worst pull at them: they are looked at again without those.
  std::erase_if(far, [&](const GraphEdge& e) { return e.residual < worst / 2; });
  for (const GraphEdge& e : far) edges_.erase({e.a, e.b, e.kind});
  loops_let_go_ += far.size();
  summary.let_go.insert(summary.let_go.end(), far.begin(), far.end());
  return !far.empty();
}

}  // namespace dynslam
