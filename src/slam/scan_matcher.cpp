// SPDX-License-Identifier: MIT
#include "slam/scan_matcher.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "slam/byte_search.h"
#include "slam/smooth_hits.h"

namespace dynslam {
namespace {

constexpr int kCoarse = HitWindow::kPool;  ///< side of a cell of the wide search, in cells
constexpr int kMostFineHalf = 7;           ///< a row of 2 * 7 + 1 shifts is one load
constexpr int kRowsAtOnce = 3;             ///< no window is narrower; their sums fit into registers
// Bounds on the work of a wide search, whatever the prior and the cell size: some ten milliseconds.
constexpr int kMostCoarseHalf = 24;
constexpr int kMostCoarseYaws = 60;
constexpr std::size_t kMostSparse = 360;
constexpr std::size_t kCandidates = 4;
constexpr int kMostIterations = 10;
constexpr int kLastSteps = 2;      ///< of these, with all points: all but the first
constexpr double kSettled = 0.05;  ///< cells: a step this short is followed by the last ones
constexpr int kStray = 3;  ///< cells that refinement may move: more means that it follows something else
/// In a wide search a point in space that was never seen is worth this much, of 255 for one on a hit; in free
/// space it is worth nothing. Otherwise the search would rather stay where the map is known than follow the
/// robot into the new.
constexpr std::uint8_t kUnknownWorth = 100;
/// Beams next to each other err together: a point counts as this much of an independent one.
constexpr double kEvidence = 0.3;
constexpr float kOnHit =
    0.03F;  ///< a point this much on hits is on the map: half a cell beside a single look

/// What hit bytes are multiplied by before matching. On a map that saw each wall some twenty times, counts
/// show where in the noise the wall is. On a map of a few looks they say little but that there is a wall, and
/// the more one-look cells count like any other the better; in between it is a matter of degree.
float gain_for(double usual_hit) {
  constexpr double kSureHit = 180.0, kMost = 20.0;
  const double short_of = kSureHit / std::max(1.0, usual_hit);
  return static_cast<float>(std::clamp(short_of * short_of * short_of, 1.0, kMost));
}

}  // namespace

MatchResult ScanMatcher::match(const ChunkedGrid& map, std::span<const MatchPoint> points_robot,
                               const MatchPrior& prior) {
  const double cell = map.cell_size_m();
  const Pose2 expected{prior.map_T_robot.x / cell, prior.map_T_robot.y / cell, prior.map_T_robot.yaw};
  const double sigma_cells = prior.sigma_xy_m / cell;
  expected_.xy_information = 1 / (sigma_cells * sigma_cells);
  expected_.yaw_information = 1 / (prior.sigma_yaw_rad * prior.sigma_yaw_rad);
  const float gain = gain_for(prior.usual_hit);
  MatchResult result;
  Eigen::Matrix3d information =
      Eigen::Vector3d(expected_.xy_information, expected_.xy_information, expected_.yaw_information)
          .asDiagonal();
  Pose2 found = expected;
  if (!points_robot.empty() && map.chunk_count() > 0) {
    const double half_xy = std::max(config_.search_half_width_m / cell, config_.window_sigmas * sigma_cells);
    const double half_yaw = config_.window_sigmas * prior.sigma_yaw_rad;
    choose_sparse(points_robot);
    const bool wide = half_xy > kMostFineHalf;
    // The search ends on whole steps beyond its range and looks around its candidates; refinement may stray
    // from there.
    const double reach = half_xy + (wide ? 3 * kCoarse : 1) + kStray;
    const double turn_reach = half_yaw + (2 * kCoarse + kStray) / far_cells_;
    const auto load = [&](std::uint8_t unknown) {
      fine_.load(map, points_robot, expected, static_cast<float>(reach), static_cast<float>(turn_reach), gain,
                 unknown);
    };
    load(wide ? kUnknownWorth : std::uint8_t{0});
    const Pose2 first{static_cast<double>(fine_.first().x), static_cast<double>(fine_.first().y), 0};
    expected_.window_T_robot = {expected.x - first.x, expected.y - first.y, expected.yaw};
    const Candidate best = search_all(half_xy, half_yaw);
    if (wide) load(0);
    found = first * refine(points_robot, best.window_T_robot, information);
    judge(map, found, result);
  }
  const Eigen::Vector3d scale(cell, cell, 1.0);
  result.map_T_robot = {found.x * cell, found.y * cell, wrap_angle(found.yaw)};
  result.covariance = scale.asDiagonal() * information.inverse() * scale.asDiagonal();
  return result;
}

/// The exhaustive search needs to find the right cell, no more: some hundred points, evenly spread, are
/// enough.
void ScanMatcher::choose_sparse(std::span<const MatchPoint> points) {
  float total = 0;
  for (const MatchPoint& p : points) total += p.weight;
  const float step = std::max(1.0F, total / static_cast<float>(kMostSparse));
  sparse_.clear();
  float passed = 0;
  for (const MatchPoint& p : points) {
    passed += p.weight;
    if (passed < step) continue;
    passed -= step;
    sparse_.push_back({p.x, p.y, step, p.nx, p.ny});
  }
  if (sparse_.empty()) sparse_.assign(points.begin(), points.end());
  weight_of_sparse_ = total / static_cast<double>(sparse_.size());
  std::vector<float> ranges;
  ranges.reserve(sparse_.size());
  for (const MatchPoint& p : sparse_) ranges.push_back(std::hypot(p.x, p.y));
  const auto far = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() * 3 / 4);
  std::nth_element(ranges.begin(), far, ranges.end());
  far_cells_ = std::max(10.0F, *far);
}

/// Where the sparse points lie in a window when moved by the least that the search moves them; those that a
/// shift could take out of the window are left out.
void ScanMatcher::place_sparse(const HitWindow& window, const Pose2& window_T_robot, int half_cells,
                               double cell_factor) {
  const auto per_cell = static_cast<float>(1 / cell_factor);
  const auto c = static_cast<float>(std::cos(window_T_robot.yaw)) * per_cell,
             s = static_cast<float>(std::sin(window_T_robot.yaw)) * per_cell;
  const auto x0 = static_cast<float>(window_T_robot.x), y0 = static_cast<float>(window_T_robot.y);
  offsets_.resize(sparse_.size());
  std::size_t inside = 0;
  for (const MatchPoint& p : sparse_) {
    // The window has no negative cells.
    const int x = static_cast<int>(x0 + c * p.x - s * p.y) - half_cells;
    const int y = static_cast<int>(y0 + s * p.x + c * p.y) - half_cells;
    if (!window.contains(x, y) || !window.contains(x + 2 * half_cells, y + 2 * half_cells)) continue;
    offsets_[inside++] = y * window.stride() + x;
  }
  offsets_.resize(inside);
}

/// The best shift of the placed points by up to `half_cells` either way, against the prior. `cell_factor`:
/// cells of the map to one of this window.
ScanMatcher::Candidate ScanMatcher::best_shift(const HitWindow& window, const Pose2& centre, int half_cells,
                                               double cell_factor) const {
  const Pose2& prior = expected_.window_T_robot;
  const double worth = kEvidence * weight_of_sparse_ / 255.0;
  const double xy_cost = 0.5 * expected_.xy_information * cell_factor * cell_factor;
  const double yaw_off = turn(prior.yaw, centre.yaw);
  const double yaw_cost = 0.5 * expected_.yaw_information * yaw_off * yaw_off;
  const int width = 2 * half_cells + 1, last_rows = width - static_cast<int>(kRowsAtOnce);
  Candidate best{centre, -1e300};
  for (int first = 0; first < width; first += kRowsAtOnce) {
    const int low = std::min(first, last_rows);  // the last ones may be looked at twice
    for (int left = 0; left < width; left += HitWindow::kLanes) {
      const auto rows =
          score_rows<kRowsAtOnce>(window.data() + static_cast<std::ptrdiff_t>(low) * window.stride() + left,
                                  window.stride(), offsets_);
      const int lanes = std::min(HitWindow::kLanes, width - left);
      for (std::size_t r = 0; r < kRowsAtOnce; ++r) {
        const double y = centre.y + low + static_cast<int>(r) - half_cells;
        const double off_y = y - prior.y / cell_factor;
        for (int i = 0; i < lanes; ++i) {
          const double x = centre.x + left + i - half_cells, off_x = x - prior.x / cell_factor;
          const double score = worth * rows[r][static_cast<std::size_t>(i)] -
                               xy_cost * (off_x * off_x + off_y * off_y) - yaw_cost;
          if (score > best.score) best = {{x, y, centre.yaw}, score};
        }
      }
    }
  }
  return best;
}

/// Scores every shift of the sparse points by whole cells and every yaw of the range, against the prior.
/// Returns the best candidates, best first, at most one a yaw.
std::vector<ScanMatcher::Candidate> ScanMatcher::search(const HitWindow& window, const Pose2& centre,
                                                        const SearchRange& range, double cell_factor,
                                                        std::size_t candidates) {
  std::vector<Candidate> found;
  for (int k = -range.half_yaws; k <= range.half_yaws; ++k) {
    const Pose2 turned{centre.x, centre.y, centre.yaw + k * range.yaw_step_rad};
    place_sparse(window, turned, range.half_cells, cell_factor);
    found.push_back(best_shift(window, turned, range.half_cells, cell_factor));
  }
  const auto better = [](const Candidate& a, const Candidate& b) { return a.score > b.score; };
  const auto keep = found.begin() + static_cast<std::ptrdiff_t>(std::min(found.size(), candidates));
  std::partial_sort(found.begin(), keep, found.end(), better);
  found.erase(keep, found.end());
  return found;
}

/// The best cell and yaw of the whole range: at once where a row of it is one load, else coarse first.
ScanMatcher::Candidate ScanMatcher::search_all(double half_xy_cells, double half_yaw_rad) {
  const Pose2& centre = expected_.window_T_robot;
  const double fine_yaw = 1.0 / far_cells_;
  if (half_xy_cells <= kMostFineHalf && half_yaw_rad / fine_yaw <= 16) {
    const SearchRange range{std::max(1, static_cast<int>(std::ceil(half_xy_cells))),
                            static_cast<int>(std::ceil(half_yaw_rad / fine_yaw)), fine_yaw};
    return search(fine_, centre, range, 1, 1).front();
  }
  coarse_.pool(fine_);
  const double coarse_yaw = kCoarse * fine_yaw;
  const SearchRange wide{std::min(kMostCoarseHalf, static_cast<int>(std::ceil(half_xy_cells / kCoarse))),
                         std::min(kMostCoarseYaws, static_cast<int>(std::ceil(half_yaw_rad / coarse_yaw))),
                         coarse_yaw};
  Candidate best{centre, -1e300};
  for (const Candidate& r :
       search(coarse_, {centre.x / kCoarse, centre.y / kCoarse, centre.yaw}, wide, kCoarse, kCandidates)) {
    const Pose2 around{r.window_T_robot.x * kCoarse, r.window_T_robot.y * kCoarse, r.window_T_robot.yaw};
    const Candidate c = search(fine_, around, {kCoarse, kCoarse / 2 + 1, fine_yaw}, 1, 1).front();
    if (c.score > best.score) best = c;
  }
  return best;
}

/// The search takes the best cell, also in directions that the scan's surfaces leave open, as along a bare
/// corridor, where one cell is as good as another: there the prior knows better.
Pose2 ScanMatcher::along_prior(const Pose2& found, const Eigen::Matrix3d& prior_info) const {
  const Pose2& prior = expected_.window_T_robot;
  const HitFit fit = fit_to_hits(fine_, sparse_, found);
  const Eigen::Vector3d off(prior.x - found.x, prior.y - found.y, turn(found.yaw, prior.yaw));
  const Eigen::Vector3d step = (kEvidence * fit.information + prior_info).ldlt().solve(prior_info * off);
  const Pose2 pose{found.x + step.x(), found.y + step.y(), found.yaw + step.z()};
  return is_finite(pose) ? pose : found;
}

/// Newton steps up the sum of weight * smooth hit, with the prior, all in cells: with some points until it
/// settles, then with all. Hits that are not on the map, a person's say, lie where the map is flat: they push
/// nowhere. `information` is the prior's, and becomes that of the result.
Pose2 ScanMatcher::refine(std::span<const MatchPoint> points, const Pose2& start,
                          Eigen::Matrix3d& information) const {
  const Pose2& prior = expected_.window_T_robot;
  const Eigen::Matrix3d prior_info = information;
  const Pose2 begun = along_prior(start, prior_info);
  Pose2 pose = begun;
  int last_steps = kLastSteps;
  for (int iteration = 0; iteration < kMostIterations && last_steps > 0; ++iteration) {
    const bool settled = last_steps < kLastSteps;
    const Eigen::Vector3d off(prior.x - pose.x, prior.y - pose.y, turn(pose.yaw, prior.yaw));
    const HitFit fit = fit_to_hits(fine_, settled ? points : std::span<const MatchPoint>(sparse_), pose);
    information = kEvidence * fit.information + prior_info;
    const Eigen::Vector3d step = information.ldlt().solve(kEvidence * fit.gradient + prior_info * off);
    pose = {pose.x + step.x(), pose.y + step.y(), pose.yaw + step.z()};
    const bool strayed = std::abs(pose.x - begun.x) > kStray || std::abs(pose.y - begun.y) > kStray ||
                         std::abs(pose.yaw - begun.yaw) * far_cells_ > kStray;
    if (strayed || !is_finite(pose)) return start;
    const double moved = std::max(step.head<2>().norm(), std::abs(step.z()) * far_cells_);
    if (settled || moved < kSettled || iteration + kLastSteps >= kMostIterations) --last_steps;
  }
  return pose;
}

/// How much of the scan the map explains at the pose found.
void ScanMatcher::judge(const ChunkedGrid& map, const Pose2& pose, MatchResult& result) const {
  const auto c = static_cast<float>(std::cos(pose.yaw)), s = static_cast<float>(std::sin(pose.yaw));
  const Pose2 in_window{pose.x - fine_.first().x, pose.y - fine_.first().y, pose.yaw};
  double all = 0, known = 0, matched = 0, smooth = 0, hits = 0, hit_bytes = 0;
  for (const MatchPoint& p : sparse_) {
    const float dx = c * p.x - s * p.y, dy = s * p.x + c * p.y;
    const float hit =
        smooth_hit(fine_, static_cast<float>(in_window.x) + dx, static_cast<float>(in_window.y) + dy);
    all += 1;
    const CellIndex cell{floor_to_int(pose.x + dx), floor_to_int(pose.y + dy)};
    const std::uint8_t byte = map.hit(cell);
    hits += byte > 0 ? 1 : 0;
    hit_bytes += byte;
    const bool on_hit = hit > kOnHit;
    if (!on_hit && map.state(cell) == CellState::kUnknown) continue;
    known += 1;
    matched += on_hit ? 1 : 0;
    smooth += hit;
  }
  result.mean_hit = hits > 0 ? hit_bytes / hits : 0;
  result.known = all > 0 ? known / all : 0;
  result.matched = known > 0 ? matched / known : 0;
  result.score = known > 0 ? smooth / known : 0;
}

}  // namespace dynslam
