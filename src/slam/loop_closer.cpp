// SPDX-License-Identifier: MIT
#include "slam/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/LU>

#include "base/number_text.h"

namespace dynslam {
namespace {

/// Maps that follow each other share scans: what they agree on says nothing new.
constexpr std::uint32_t kNeighbours = 2;
constexpr std::size_t kMostCandidates = 3;
constexpr std::size_t kLookPoints = 100;  ///< of a map, to see how much of it another may know
constexpr double kLeastShare = 0.3;

/// The fit of a closure knows nothing of how the maps themselves are bent.
constexpr double kClosureInflation = 4.0;
constexpr double kClosureBend_m = 0.008;
constexpr double kClosureBend_rad = 0.002;

constexpr double kWindowSigmas = 3.0;
/// Squared Mahalanobis distance from what the graph expects: five standard deviations are a contradiction.
constexpr double kGate = 25.0;

// Loops that contradict the graph: so many, from two places at least, must ask for the same correction.
constexpr std::size_t kWitnesses = 3;
constexpr std::size_t kMostClaims = 48;
constexpr double kSameCorrection_m = 0.1;
constexpr double kSameCorrection_rad = 0.02;

/// Odometry drifts by less, however long the way.
constexpr double kGuess_m = 10.0;

/// With the graph silent, the maps have to say it all. (In drawn flats the right place is contradicted by
/// nothing and the best of the wrong ones, found all over a room and all around, by 0.13.)
constexpr LoopRules kRulesForGuesses{.least_matched = 0.85, .most_contradicted = 0.08};

constexpr double kWideShare = 0.4;
constexpr SearchWindow kWideWindow{1.0, 1.0, radians(12)};

constexpr std::size_t kMostRefused = 500;

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
  // A robot that was lost may be anywhere and turned any way: as far about as the search's budget allows.
  const bool is_guess = is_anyones_guess(covariance), is_turn_known = covariance(2, 2) < 0.1;
  const double most_m = is_guess && is_turn_known ? 6.0 : 4.0, most_rad = is_guess ? kPi : radians(20);
  SearchWindow window;
  window.half_x_m = std::clamp(kWindowSigmas * std::sqrt(covariance(0, 0)), 0.15, most_m);
  window.half_y_m = std::clamp(kWindowSigmas * std::sqrt(covariance(1, 1)), 0.15, most_m);
  window.half_yaw_rad = std::clamp(kWindowSigmas * std::sqrt(covariance(2, 2)), radians(2), most_rad);
  return window;
}

/// How a loop would move its source in the map.
Pose2 correction_of(const PoseGraph& graph, std::uint32_t a, std::uint32_t b, const Pose2& a_T_b) {
  return graph.pose(a) * a_T_b * graph.pose(b).inverse();
}

bool ask_for_the_same(const Pose2& one, const Pose2& other, const Vector2& at) {
  return (one * at - other * at).norm() < kSameCorrection_m &&
         std::abs(turn(one.yaw, other.yaw)) < kSameCorrection_rad;
}

}  // namespace

bool is_anyones_guess(const Eigen::Matrix3d& covariance) {
  return covariance.topLeftCorner<2, 2>().trace() > kGuess_m * kGuess_m;
}

void LoopCloser::know(std::shared_ptr<const FinishedMap> map) {
  Known& known = maps_[map->id];
  known.map = std::move(map);
  for (const Vector2& p : known.map->outline) known.reach_m = std::max(known.reach_m, p.norm());
}

bool LoopCloser::close(std::shared_ptr<const FinishedMap> map) {
  const std::uint32_t id = map->id;
  know(std::move(map));
  const Known& source = maps_.at(id);
  const std::uint64_t before = closures_;
  const std::vector<Candidate> likely = candidates(source);
  for (const Candidate& c : likely) {
    const double yaw = maps_.at(c.id).map->drawn_T_origin.yaw;
    try_loop(*source.map, c, window_for(turned(c.target_T_source.covariance, yaw)));
  }
  if (closures_ == before) look_about(*source.map, likely);
  return closures_ > before;
}

/// A place that should have been known again was not: odometry may have slipped by more than it owns to. The
/// one of the candidates that should know most of the source is searched widely.
void LoopCloser::look_about(const FinishedMap& source, const std::vector<Candidate>& candidates) {
  const auto best =
      std::max_element(candidates.begin(), candidates.end(),
                       [](const Candidate& a, const Candidate& b) { return a.share < b.share; });
  if (best == candidates.end() || best->share < kWideShare) return;
  counters_.add("loops.searched_widely");
  try_loop(source, *best, kWideWindow);
}

void LoopCloser::forget(std::uint32_t id) {
  maps_.erase(id);
  std::erase_if(claims_, [id](const Claim& c) { return c.a == id || c.b == id; });
}

void LoopCloser::forget_refused_before(std::uint32_t id) {
  const auto is_gone = [&](std::uint32_t map) { return map < id && !maps_.contains(map); };
  for (auto* loops : {&refused_, &let_go_})
    std::erase_if(*loops, [&](const RefusedLoop& r) { return is_gone(r.a) || is_gone(r.b); });
}

/// Maps that may show the same place, those first whose place relative to this one is least known for what
/// they share.
std::vector<LoopCloser::Candidate> LoopCloser::candidates(const Known& source) const {
  std::vector<Candidate> found;
  const std::uint32_t source_id = source.map->id;
  const std::vector<Vector2> points = thin_out(source.map->outline, kLookPoints, 0.1);
  if (points.empty()) return found;
  const auto relatives = graph_.relatives_of(source_id);
  for (const auto& [id, other] : maps_) {
    if (id + kNeighbours > source_id || !relatives.contains(id)) continue;
    const Pose2 guess = graph_.pose(id).inverse() * graph_.pose(source_id);
    const RelativePose measured = inverse(relatives.at(id));
    const double unsure_m = std::sqrt(measured.covariance(0, 0) + measured.covariance(1, 1));
    if (guess.translation().norm() > source.reach_m + other.reach_m + unsure_m) continue;
    const double share = share_known(*other.map, guess, points);
    if (share < kLeastShare && unsure_m < 1.0) continue;
    found.push_back({id, {guess, measured.covariance}, share, std::max(share, 0.1) * (0.01 + unsure_m)});
  }
  const auto keep = found.begin() + static_cast<std::ptrdiff_t>(std::min(found.size(), kMostCandidates));
  std::partial_sort(found.begin(), keep, found.end(),
                    [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
  found.erase(keep, found.end());
  return found;
}

void LoopCloser::try_loop(const FinishedMap& source, const Candidate& candidate, const SearchWindow& window) {
  const FinishedMap& target = *maps_.at(candidate.id).map;
  const RelativePose& expected = candidate.target_T_source;
  const LoopMatch match = find_loop(MaxPyramid(target), target, source, expected.pose, window);
  counters_.add("loops.searched");
  const Claim claim{candidate.id,
                    source.id,
                    {match.target_T_source, kClosureInflation * Eigen::Matrix3d(match.information.inverse()) +
                                                spread(kClosureBend_m, kClosureBend_rad)}};
  const bool is_guess = is_anyones_guess(expected.covariance);
  if (const auto why = refusal(match, is_guess ? kRulesForGuesses : LoopRules{})) return refuse(claim, *why);
  const RelativePose both{claim.a_T_b.pose, claim.a_T_b.covariance + expected.covariance};
  if (is_guess || mahalanobis2(both, expected.pose) > kGate) return hear_claim(claim);
  add(claim);
}

/// Takes a loop that contradicts the graph in, with those that say the same, once they are enough.
void LoopCloser::hear_claim(const Claim& claim) {
  std::erase_if(claims_, [&](const Claim& c) { return c.a == claim.a && c.b == claim.b; });
  const Vector2 at = graph_.pose(claim.b).translation();
  const Pose2 wanted = correction_of(graph_, claim.a, claim.b, claim.a_T_b.pose);
  std::vector<Claim> same{claim};
  std::set<std::uint32_t> places{claim.b};
  for (const Claim& other : claims_) {
    if (!ask_for_the_same(wanted, correction_of(graph_, other.a, other.b, other.a_T_b.pose), at)) continue;
    same.push_back(other);
    places.insert(other.b);
  }
  claims_.push_back(claim);
  if (claims_.size() > kMostClaims) claims_.pop_front();
  if (same.size() < kWitnesses || places.size() < 2) return refuse(claim, "inconsistent");
  counters_.add("loops.claims_believed", same.size());
  for (const Claim& c : same) add(c);
  std::erase_if(claims_, [&](const Claim& c) {
    return std::any_of(same.begin(), same.end(), [&](const Claim& s) { return s.a == c.a && s.b == c.b; });
  });
}

void LoopCloser::add(const Claim& claim) {
  if (graph_.add_loop_edge(claim.a, claim.b, claim.a_T_b.pose, claim.a_T_b.covariance)) ++closures_;
}

void LoopCloser::refuse(const Claim& claim, std::string_view why) {
  counters_.add("loops.refused." + std::string(why));
  refused_.push_back({claim.a, claim.b, claim.a_T_b.pose, std::string(why)});
  if (refused_.size() > kMostRefused) refused_.pop_front();
}

void LoopCloser::note_let_go(const std::vector<GraphEdge>& edges) {
  for (const GraphEdge& e : edges) {
    counters_.add("loops.let_go");
    std::string why;
    append_fixed(why, e.residual, 1);
    let_go_.push_back({e.a, e.b, e.a_T_b, why + " sigma off"});
    if (let_go_.size() > kMostRefused) let_go_.pop_front();
  }
}

}  // namespace dynslam
