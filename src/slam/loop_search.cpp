// SPDX-License-Identifier: MIT
#include "slam/loop_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/surface_fit.h"

namespace dynslam {
namespace {

/// A base cell's byte from which on a point in it counts as on a surface: about a cell off.
constexpr std::uint8_t kOnSurface = 90;
/// Around a target's point, this much of the source's space must be free all over to contradict it.
constexpr double kClear_m = 0.1;

bool is_sound(const SearchWindow& w) {
  return std::isfinite(w.half_x_m) && std::isfinite(w.half_y_m) && std::isfinite(w.half_yaw_rad);
}

/// What the target says of the source's points at a pose in the frame it was drawn in; shares.
struct Judgement {
  double overlap = 0.0, score = 0.0, matched = 0.0, contradicted = 0.0;
};

Judgement judge(const MaxPyramid& pyramid, const std::vector<Vector2>& points, const Pose2& pose) {
  int known = 0, matched = 0, contradicted = 0, values = 0;
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  for (const Vector2& p : points) {
    const CellIndex cell = pyramid.cell_of({pose.x + c * p.x() - s * p.y(), pose.y + s * p.x() + c * p.y()});
    if (!pyramid.is_known(cell)) continue;
    const std::uint8_t value = pyramid.value(0, cell);
    ++known;
    values += value;
    matched += value >= kOnSurface ? 1 : 0;
    contradicted += pyramid.is_clear(cell) ? 1 : 0;
  }
  if (known == 0) return {};
  const double share = 1.0 / known;
  return {known / static_cast<double>(points.size()), share * values / 255.0, share * matched,
          share * contradicted};
}

/// How well the best pose elsewhere explains what it shares with the target, over how well the best pose
/// does. Not how much: in the next of two aisles that look alike, half the map lies in the dark and nothing
/// speaks against it.
double runner_up(const MaxPyramid& pyramid, const std::vector<Vector2>& points, const Pose2& best,
                 const Pose2& rival) {
  const double of_best = judge(pyramid, points, best).score;
  return of_best > 0 ? judge(pyramid, points, rival).score / of_best : 0.0;
}

bool is_clear(const FinishedMap& map, CellIndex at, int reach) {
  for (int y = at.y - reach; y <= at.y + reach; ++y) {
    for (int x = at.x - reach; x <= at.x + reach; ++x) {
      if (!map.free.test({x, y})) return false;
    }
  }
  return true;
}

/// Whether the source looked through what the target holds to be solid.
void judge_target(const FinishedMap& target, const FinishedMap& source, std::size_t points,
                  LoopMatch& match) {
  const Pose2 drawn_T_target = source.drawn_T_origin * match.target_T_source.inverse();
  const int reach = static_cast<int>(std::ceil(kClear_m / source.cell_size_m));
  int known = 0, contradicted = 0;
  for (const Vector2& p : thin_out(target.outline, points, target.cell_size_m)) {
    const CellIndex cell = cell_at(drawn_T_target * p, source.cell_size_m);
    const bool free = source.free.test(cell);
    if (!free && !source.occupied.test(cell)) continue;
    ++known;
    contradicted += free && is_clear(source, cell, reach) ? 1 : 0;
  }
  if (known > 0) match.contradicted_back = static_cast<double>(contradicted) / known;
}

/// Least over greatest eigenvalue of the x, y part.
double roundness_of(const Eigen::Matrix3d& information) {
  const double mean = 0.5 * (information(0, 0) + information(1, 1));
  const double spread = Vector2(0.5 * (information(0, 0) - information(1, 1)), information(0, 1)).norm();
  return mean + spread > 0 ? std::max(0.0, mean - spread) / (mean + spread) : 0.0;
}

}  // namespace

LoopMatch find_loop(const MaxPyramid& pyramid, const FinishedMap& target, const FinishedMap& source,
                    const Pose2& guess, const SearchWindow& window, const LoopSearchConfig& config) {
  LoopMatch match;
  match.target_T_source = guess;
  if (!is_finite(guess) || guess.translation().norm() > 1e5 || !is_sound(window)) return match;
  const std::vector<Vector2> coarse = thin_out(source.outline, config.search_points, pyramid.cell_size_m());
  PyramidSearch search(pyramid, coarse, target.drawn_T_origin * guess, window, config.search);
  const PyramidSearchResult found = search.run();
  match.nodes = found.nodes;
  match.out_of_budget = found.out_of_budget;
  if (!found.best) return match;
  match.found = true;
  const Pose2 best = search.pose_of(*found.best);  // in the frame the target was drawn in
  if (found.rival) match.runner_up = runner_up(pyramid, coarse, best, search.pose_of(*found.rival));
  const std::vector<Vector2>& points = source.outline;
  const SurfaceFit surfaces(target.cloud, target.cell_size_m);
  const SurfaceFit::Result fit = surfaces.fit(points, target.drawn_T_origin.inverse() * best);
  match.target_T_source = fit.cloud_T_points;
  match.information = fit.information;
  match.residual_m = fit.residual_m;
  match.roundness = roundness_of(fit.information);
  const Judgement judged = judge(pyramid, points, target.drawn_T_origin * match.target_T_source);
  match.points = static_cast<int>(points.size());
  match.overlap = judged.overlap;
  match.score = judged.score;
  match.matched = judged.matched;
  match.contradicted = judged.contradicted;
  judge_target(target, source, config.search_points, match);
  return match;
}

std::optional<std::string_view> refusal(const LoopMatch& match, const LoopRules& rules) {
  if (match.out_of_budget) return "out of budget";
  if (!match.found) return "nothing found";
  if (match.overlap < rules.least_overlap) return "too little overlap";
  if (match.overlap * match.points < rules.least_overlap_points) return "too little overlap";
  if (std::max(match.contradicted, match.contradicted_back) > rules.most_contradicted) return "contradicted";
  if (match.score < rules.least_score || match.matched < rules.least_matched) return "poor score";
  if (match.runner_up > rules.most_runner_up) return "ambiguous";
  if (match.roundness < rules.least_roundness) return "degenerate";
  return std::nullopt;
}

}  // namespace dynslam
