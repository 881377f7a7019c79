// SPDX-License-Identifier: MIT
#include "slam/finished_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace dynslam {
namespace {

/// The squares of a lattice that hold points, counted in the order they were first met: a table by hashes, as
/// they are few in a large rectangle.
class Squares {
 public:
  explicit Squares(std::size_t most) : places_(std::bit_ceil(2 * most + 1), 0) {}

  /// The number of a square. REQUIRES: no more than `most` different ones.
  std::size_t number_of(std::uint32_t column, std::uint32_t row) {
    const std::uint64_t key = std::uint64_t{row} << 32 | column;
    std::size_t at = (key * 0x9E3779B97F4A7C15ULL >> 40) & (places_.size() - 1);
    for (; places_[at] != 0; at = (at + 1) & (places_.size() - 1)) {
      if (keys_[places_[at] - 1] == key) return places_[at] - 1;
    }
    keys_.push_back(key);
    places_[at] = static_cast<std::uint32_t>(keys_.size());
    return keys_.size() - 1;
  }

 private:
  std::vector<std::uint32_t> places_;  ///< in keys_, counted from 1
  std::vector<std::uint64_t> keys_;
};

/// The mean of the points in each square of `step_m` that holds any.
std::vector<Vector2> one_a_square(const std::vector<Vector2>& points, double step_m, const Vector2& low) {
  const auto steps = [step_m](double m) { return static_cast<std::uint32_t>(std::min(m / step_m, 4e9)); };
  Squares squares(points.size());
  std::vector<Vector2> kept;
  std::vector<double> count;
  for (const Vector2& p : points) {
    const std::size_t i = squares.number_of(steps(p.x() - low.x()), steps(p.y() - low.y()));
    if (i == kept.size()) {
      kept.emplace_back(0, 0);
      count.push_back(0);
    }
    kept[i] += p;
    count[i] += 1;
  }
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] /= count[i];
  return kept;
}

}  // namespace

std::vector<Vector2> thin_out(const std::vector<Vector2>& points, std::size_t most, double least_step_m) {
  constexpr int kMostRounds = 40;
  if (points.empty() || most == 0) return {};
  Vector2 low = points.front();
  for (const Vector2& p : points) low = low.cwiseMin(p);
  // Surfaces are lines: the squares that they touch are fewer as the squares are larger.
  double step = least_step_m;
  std::vector<Vector2> kept = one_a_square(points, step, low);
  for (int round = 0; round < kMostRounds && kept.size() > most; ++round) {
    step *= std::max(1.05, static_cast<double>(kept.size()) / static_cast<double>(most));
    kept = one_a_square(points, step, low);
  }
  return kept;
}

std::vector<Vector2> thin_out(const std::vector<CloudPoint>& cloud, std::size_t most, double least_step_m) {
  std::vector<Vector2> points;
  points.reserve(cloud.size());
  for (const CloudPoint& p : cloud) {
    if (std::isfinite(p.x_m) && std::isfinite(p.y_m)) points.emplace_back(p.x_m, p.y_m);
  }
  return thin_out(points, most, least_step_m);
}

}  // namespace dynslam
