// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "base/pose2.h"
#include "slam/finished_map.h"
#include "slam/max_pyramid.h"
#include "slam/pyramid_search.h"

namespace dynslam {

/// What a loop search found, and what speaks for and against it. Shares are 0 to 1.
struct LoopMatch {
  bool found = false;     ///< false: no pose in the window beats empty hands; nothing else is filled in
  Pose2 target_T_source;  ///< between the origins of the two maps
  /// Inverse covariance of (x, y, yaw) of target_T_source, in the target's frame: 1/m2, 1/(m rad), 1/rad2.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();

  int points = 0;             ///< of the source that were judged: evenly over its surfaces
  double overlap = 0.0;       ///< share of them in space that the target has seen
  double score = 0.0;         ///< mean value, 1 on a surface, 0 away from all, of those in the overlap
  double matched = 0.0;       ///< share of those that are on a surface, within about a cell of the pyramid
  double contradicted = 0.0;  ///< share of those where the target saw free space, away from all surfaces
  double contradicted_back = 0.0;  ///< the same of the target's points where the source saw free space
  double residual_m = 0.0;         ///< mean distance from the target's surfaces
  /// Score of the best pose clearly elsewhere over that of this one, each over its own overlap; 0: none has
  /// the evidence to be looked at.
  double runner_up = 0.0;
  /// Information about the least known direction of x, y over that about the best known: 0 in a bare
  /// corridor.
  double roundness = 0.0;
  int nodes = 0;
  bool out_of_budget = false;
};

struct LoopSearchConfig {
  std::size_t search_points = 400;  ///< of the source's outline; all of it for refinement and verdict
  PyramidSearchConfig search;
};

/// Where a newly finished map lies relative to another that may show the same place: branch and bound over
/// the window, refinement below the size of a cell, and the figures for a verdict. `pyramid` is that of
/// `target`. `guess` is target_T_source as odometry and earlier closures have it, half widths of the window
/// say how far off that may be. Pure: same input, same answer.
LoopMatch find_loop(const MaxPyramid& pyramid, const FinishedMap& target, const FinishedMap& source,
                    const Pose2& guess, const SearchWindow& window, const LoopSearchConfig& config = {});

/// What a match must show to become a constraint. A closure too few costs a little drift; a wrong one folds
/// the map.
struct LoopRules {
  double least_overlap = 0.3;
  int least_overlap_points = 80;
  double least_score = 0.5;
  double least_matched = 0.65;
  double most_contradicted = 0.2;
  double most_runner_up = 0.85;
  double least_roundness = 0.03;
};

/// Why a match must not become a constraint; nothing when it may.
std::optional<std::string_view> refusal(const LoopMatch& match, const LoopRules& rules = {});

}  // namespace dynslam
