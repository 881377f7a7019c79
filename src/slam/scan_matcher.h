// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "base/pose2.h"
#include "grid/chunked_grid.h"
#include "slam/hit_window.h"

namespace dynslam {

/// Where a scan is expected, and how far off that may be.
struct MatchPrior {
  Pose2 map_T_robot;
  double sigma_xy_m = 0.03;
  double sigma_yaw_rad = 0.01;
  /// Mean hit byte (0 to 255) where scans' points lay on this map of late: on a young map, or one of sparse
  /// scans, few looks have to weigh as much as many do on a sure one.
  double usual_hit = 255.0;
};

struct MatchResult {
  Pose2 map_T_robot;
  Eigen::Matrix3d covariance =
      Eigen::Matrix3d::Zero();  ///< of (x, y, yaw): m2, m rad, rad2; of the match together with the prior
  double score = 0.0;  ///< 0 to 1: how well the points lie on the map's hits, of those in space the map knows
  double matched = 0.0;   ///< share of the points in known space that lie on or next to a hit
  double known = 0.0;     ///< share of the points that lie in known space at all
  double mean_hit = 0.0;  ///< mean hit byte of the cells with hits that points lie in
};

struct ScanMatcherConfig {
  double search_half_width_m = 0.1;  ///< least half width of the square that is searched
  double window_sigmas = 3.0;        ///< half width of the search in standard deviations of the prior
};

/// Finds the pose from which a scan's points lie best on the hits of a map.
///
/// First an exhaustive search over x, y and yaw, a byte load scoring 16 neighbouring x at once (correlative
/// matching, Olson 2009); wide windows begin on cells four times as large. Then Newton steps on the hit plane
/// seen through a cubic B-spline, which is smooth below the size of a cell, with the prior as one more
/// measurement. Keeps its buffers between calls. One thread.
class ScanMatcher {
 public:
  explicit ScanMatcher(const ScanMatcherConfig& config = {}) : config_(config) {}

  /// `points_robot` in cells, robot frame. Always answers; whether to believe the answer is the caller's to
  /// judge by score, matched and known. With no points the answer is the prior with score 0.
  MatchResult match(const ChunkedGrid& map, std::span<const MatchPoint> points_robot,
                    const MatchPrior& prior);

 private:
  struct Candidate {
    Pose2 window_T_robot;  ///< cells
    double score = 0.0;    ///< sum of weight * hit, less what the prior holds against it
  };
  /// The prior as the matcher works with it: cells, in the window.
  struct Expectation {
    Pose2 window_T_robot;
    double xy_information = 0.0, yaw_information = 0.0;
  };
  struct SearchRange {
    int half_cells = 0;
    int half_yaws = 0;
    double yaw_step_rad = 0.0;
  };

  void place_sparse(const HitWindow& window, const Pose2& window_T_robot, int half_cells, double cell_factor);
  Candidate best_shift(const HitWindow& window, const Pose2& centre, int half_cells,
                       double cell_factor) const;
  std::vector<Candidate> search(const HitWindow& window, const Pose2& centre, const SearchRange& range,
                                double cell_factor, std::size_t candidates);
  Candidate search_all(double half_xy_cells, double half_yaw_rad);
  void choose_sparse(std::span<const MatchPoint> points);
  Pose2 along_prior(const Pose2& found, const Eigen::Matrix3d& prior_info) const;
  Pose2 refine(std::span<const MatchPoint> points, const Pose2& start, Eigen::Matrix3d& information) const;
  void judge(const ChunkedGrid& map, const Pose2& map_T_robot_cells, MatchResult& result) const;

  ScanMatcherConfig config_;
  Expectation expected_;  ///< of the match at hand
  HitWindow fine_;
  HitWindow coarse_;
  std::vector<MatchPoint> sparse_;     ///< the points that the exhaustive search looks at
  double weight_of_sparse_ = 1.0;      ///< points that each of them stands for
  float far_cells_ = 0.0F;             ///< most of the sparse points are nearer
  std::vector<std::int32_t> offsets_;  ///< of those in the window at hand, as they are placed
};

}  // namespace dynslam
