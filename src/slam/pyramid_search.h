// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/angles.h"
#include "base/pose2.h"
#include "slam/byte_search.h"
#include "slam/max_pyramid.h"

namespace dynslam {

/// How far from a guess the truth may lie, either way; along the axes of the frame the target was drawn in.
struct SearchWindow {
  double half_x_m = 1.0;
  double half_y_m = 1.0;
  double half_yaw_rad = radians(8.0);
};

struct PyramidSearchConfig {
  /// Most loads of 16 shifts by all points: some 0.6 us each with 400 points.
  int max_nodes = 60000;
  /// A pose is not worth finding unless its points score so much more than unknown space, of 255.
  double least_evidence = 8.0;
  double rival_m = 0.4;             ///< a rival is at least this far from the best pose,
  double rival_rad = radians(8.0);  ///< or turned by this much,
  double rival_floor = 0.3;         ///< and has at least this share of its evidence
};

/// A pose on the lattice of the search: whole base cells and yaw steps from the guess.
struct LatticePose {
  int x = 0, y = 0, yaw = 0;
  std::uint32_t sum = 0;  ///< of the bytes that the points lie on
};

struct PyramidSearchResult {
  std::optional<LatticePose> best;  ///< none: nothing in the window has the least evidence
  std::optional<LatticePose>
      rival;  ///< the best of those that are clearly elsewhere; none: all below the floor
  int nodes = 0;
  bool out_of_budget = false;  ///< what was found until then may not be the best
};

/// Finds the lattice pose of the source, in the frame the target was drawn in, at which the source's points
/// score most on the target: branch and bound over x and y for every yaw (Hess et al., ICRA 2016), 16
/// neighbouring blocks of x at once on every level. Then the best one clearly elsewhere. The lattice's yaw
/// step moves the farthest point by one cell. Work is bounded by nodes, so that the same input gives the same
/// answer on every machine. One thread.
class PyramidSearch {
 public:
  /// `points_m` in the frame of the source's origin. All must outlive the search.
  /// REQUIRES: guess and window finite.
  PyramidSearch(const MaxPyramid& target, std::span<const Vector2> points_m, const Pose2& guess,
                const SearchWindow& window, const PyramidSearchConfig& config = {});

  PyramidSearchResult run();

  Pose2 pose_of(const LatticePose& p) const;
  /// What the points score at one pose of the lattice, the slow way.
  std::uint32_t score(const LatticePose& p) const;
  int half_x() const { return half_x_; }
  int half_y() const { return half_y_; }
  int half_yaws() const { return half_yaws_; }

 private:
  /// 16 blocks of shifts side by side: lane m has x + m S to x + m S + S - 1, y to y + S - 1, S = 2^level.
  struct Strip {
    int x = 0, y = 0, yaw = 0, level = 0;
    Scores16 bound{};
    std::uint32_t most() const { return *std::max_element(bound.begin(), bound.end()); }
  };

  /// A level of the target with a rim as wide as the window, so that no shift of a point leaves it.
  struct RimmedPlane {
    std::vector<std::uint8_t> bytes;
    int stride = 0;
    std::vector<std::int32_t> offsets;  ///< of the points at the window's lower left shift
    int yaw = 0;                        ///< for which
  };

  void add_rim(int level);
  void place_points(int yaw);
  void find_offsets(int level);
  Strip scored(int x, int y, int level);
  void close_lanes(Strip& strip) const;
  bool is_too_near(const Strip& strip, int lane) const;
  std::vector<Strip> top_strips();
  void descend(const Strip& strip);
  void take(const Strip& leaf);
  void search(const std::vector<Strip>& strips);
  std::uint32_t sum_with_evidence(double evidence) const;

  const MaxPyramid& target_;
  std::span<const Vector2> points_;
  Pose2 guess_;
  PyramidSearchConfig config_;
  int half_x_ = 0, half_y_ = 0, half_yaws_ = 0, top_level_ = 0;
  double yaw_step_rad_ = 0.0;

  int placed_yaw_ = 0;
  std::vector<CellIndex> placed_;         ///< the points' base cells at the yaw at hand, unshifted
  std::vector<RimmedPlane> planes_;       ///< of each level
  std::uint32_t floor_ = 0;               ///< a pose must score more than this
  std::optional<LatticePose> found_;      ///< best of the pass at hand
  std::optional<LatticePose> keep_away_;  ///< second pass: not near this one
  PyramidSearchResult result_;
};

}  // namespace dynslam
