// SPDX-License-Identifier: MIT
#include "drive/route.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dynslam {
namespace {

/// Points nearer to each other are one.
constexpr double kSame_m = 1e-3;
constexpr double kAboutAsNear_m = 0.1;
constexpr double kSightStep_m = 0.05;

double distance_to_line(const Vector2& p, const Vector2& from, const Vector2& to) {
  const Vector2 way = to - from, off = p - from;
  const double squared = way.squaredNorm();
  const double share = squared > 0.0 ? std::clamp(off.dot(way) / squared, 0.0, 1.0) : 0.0;
  return (off - share * way).norm();
}

}  // namespace

Route::Route(const std::vector<Vector2>& points) {
  for (const Vector2& p : points) {
    const double step = points_.empty() ? 0.0 : (p - points_.back()).norm();
    if (!points_.empty() && step < kSame_m) continue;
    along_.push_back(points_.empty() ? 0.0 : along_.back() + step);
    points_.push_back(p);
  }
}

Vector2 Route::at(double along_m) const {
  if (along_m >= length_m()) return points_.back();
  if (along_m <= 0.0) return points_.front();
  const auto next =
      static_cast<std::size_t>(std::upper_bound(along_.begin(), along_.end(), along_m) - along_.begin());
  const double share = (along_m - along_[next - 1]) / (along_[next] - along_[next - 1]);
  return points_[next - 1] + share * (points_[next] - points_[next - 1]);
}

Route::Place Route::nearest_on_leg(const Vector2& p, std::size_t leg, double from_m, double to_m) const {
  const Vector2 ahead = (points_[leg + 1] - points_[leg]).normalized();
  const double from = std::max(from_m, along_[leg]), to = std::min(to_m, along_[leg + 1]);
  const double along = std::clamp(along_[leg] + (p - points_[leg]).dot(ahead), from, to);
  return {along, (p - points_[leg] - (along - along_[leg]) * ahead).norm()};
}

Route::Place Route::nearest(const Vector2& p, double from_m, double to_m) const {
  const double from = std::clamp(from_m, 0.0, length_m()), to = std::clamp(to_m, from, length_m());
  Place best{from, (p - at(from)).norm()};
  for (std::size_t leg = 0; leg + 1 < points_.size(); ++leg) {
    if (along_[leg + 1] < from || along_[leg] > to) continue;
    const Place place = nearest_on_leg(p, leg, from, to);
    if (place.away_m < best.away_m) best = place;
  }
  return best;
}

Route::Place Route::first_near(const Vector2& p) const {
  const Place best = nearest(p, 0.0, length_m());
  for (std::size_t leg = 0; leg + 1 < points_.size(); ++leg) {
    const Place place = nearest_on_leg(p, leg, 0.0, length_m());
    if (place.away_m <= best.away_m + kAboutAsNear_m) return place;
  }
  return best;
}

std::vector<Route::Corner> Route::corners(double from_m, double to_m) const {
  std::vector<Corner> found;
  for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
    if (along_[i] <= from_m || along_[i] >= to_m) continue;
    const Vector2 before = points_[i] - points_[i - 1], after = points_[i + 1] - points_[i];
    const double cross = before.x() * after.y() - before.y() * after.x();
    found.push_back({along_[i], std::abs(std::atan2(cross, before.dot(after)))});
  }
  return found;
}

double Route::sight_m(const Vector2& p, double from_m, double least_m, double most_m, double cut_m) const {
  const std::vector<Corner> all = corners(from_m, from_m + most_m);
  for (double sight = most_m; sight > least_m; sight -= kSightStep_m) {
    const Vector2 to = at(from_m + sight);
    const bool passes_all = std::all_of(all.begin(), all.end(), [&](const Corner& corner) {
      return corner.along_m >= from_m + sight || distance_to_line(at(corner.along_m), p, to) <= cut_m;
    });
    if (passes_all) return sight;
  }
  return least_m;
}

}  // namespace dynslam
