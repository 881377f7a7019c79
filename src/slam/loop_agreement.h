// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "slam/pose_graph.h"
#include "slam/relative_pose.h"

namespace dynslam {

/// A loop that was found but not yet believed.
struct LoopMeasurement {
  std::uint32_t a = 0, b = 0;
  RelativePose a_T_b;
};

/// 99.9 % of chi-squared with 3 degrees of freedom.
inline constexpr double kChi2Of3At999 = 16.27;

/// How far two loops contradict each other: the way around a -> b -> d -> c -> a, from b to d and from c to a
/// by odometry, must end where it began. Squared Mahalanobis distance, 3 degrees of freedom; nothing where
/// odometry does not tie the ends. The longer the odometry between the loops, the less they can contradict
/// each other. (Pairwise consistency, Mangelson et al. 2018.)
inline std::optional<double> loop_disagreement(const PoseGraph& graph, const LoopMeasurement& one,
                                               const LoopMeasurement& other) {
  const auto b_T_d = graph.odometry_between(one.b, other.b);
  const auto c_T_a = graph.odometry_between(other.a, one.a);
  if (!b_T_d || !c_T_a) return std::nullopt;
  return mahalanobis2(one.a_T_b * *b_T_d * inverse(other.a_T_b) * *c_T_a, Pose2{});
}

}  // namespace dynslam
