// SPDX-License-Identifier: MIT
#include "drive/arc_choice.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr int kArcsPerSide = 6;
/// The outermost arcs depart by this from the wanted one.
constexpr double kWidest_1pm = 6.0;
constexpr double kRolledOut_m = 0.5;
constexpr double kLeastProgress = 0.1;
constexpr double kFreedomWeight = 1.0, kProgressWeight = 1.0, kSteadyWeight = 0.4;

/// Where an arc leads after so many metres.
Vector2 end_of_arc(double curvature_1pm, double length_m) {
  const double half_turn = 0.5 * curvature_1pm * length_m;
  const double chord = std::abs(half_turn) < 1e-6 ? length_m : length_m * std::sin(half_turn) / half_turn;
  return chord * Vector2(std::cos(half_turn), std::sin(half_turn));
}

/// How much nearer to the point, for each metre; 1: straight to it.
double progress(const ArcWish& wish, double curvature_1pm) {
  const double away_m = wish.to_robot.norm();
  const double length_m = std::min(kRolledOut_m, away_m);
  if (length_m <= 0.0) return 0.0;
  return (away_m - (wish.to_robot - end_of_arc(curvature_1pm, length_m)).norm()) / length_m;
}

}  // namespace

std::optional<Arc> choose_arc(const ArcWish& wish, const AllowedSpeed& allowed_mps) {
  const double allowed = allowed_mps(wish.curvature_1pm);
  if (allowed >= wish.speed_mps) return Arc{wish.curvature_1pm, wish.speed_mps};
  std::optional<Arc> best;
  double best_score = 0.0;
  const auto consider = [&](double curvature, double most_mps) {
    const double speed = std::min(wish.speed_mps, most_mps);
    const double nearer = progress(wish, curvature);
    if (speed <= 0.0 || nearer < kLeastProgress) return;
    const double score =
        kFreedomWeight * speed / wish.speed_mps + kProgressWeight * nearer -
        kSteadyWeight * std::min(1.0, std::abs(curvature - wish.last_curvature_1pm) / kWidest_1pm);
    if (best && score <= best_score) return;
    best = Arc{curvature, speed};
    best_score = score;
  };
  consider(wish.curvature_1pm, allowed);
  for (int i = 1; i <= kArcsPerSide; ++i) {
    // Denser about the wanted one.
    const double off = kWidest_1pm * i * i / (kArcsPerSide * kArcsPerSide);
    for (const double curvature : {wish.curvature_1pm + off, wish.curvature_1pm - off})
      if (std::abs(curvature) <= wish.most_curvature_1pm) consider(curvature, allowed_mps(curvature));
  }
  return best;
}

}  // namespace dynslam
