// SPDX-License-Identifier: MIT
#include "slam/finished_map.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

/// The mean of the points in each square of `step_m` that holds any.
std::vector<Vector2> one_a_square(const std::vector<Vector2>& points, double step_m, const Vector2& low,
                                  const Vector2& high) {
  const auto columns = static_cast<std::size_t>((high.x() - low.x()) / step_m) + 1;
  const auto rows = static_cast<std::size_t>((high.y() - low.y()) / step_m) + 1;
  std::vector<std::uint32_t> place(columns * rows, 0);  // in `kept`, counted from 1
  std::vector<Vector2> kept;
  std::vector<double> count;
  for (const Vector2& p : points) {
    const auto column = static_cast<std::size_t>((p.x() - low.x()) / step_m);
    const auto row = static_cast<std::size_t>((p.y() - low.y()) / step_m);
    std::uint32_t& at = place[row * columns + column];
    if (at == 0) {
      kept.emplace_back(0, 0);
      count.push_back(0);
      at = static_cast<std::uint32_t>(kept.size());
    }
    kept[at - 1] += p;
    count[at - 1] += 1;
  }
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] /= count[i];
  return kept;
}

}  // namespace

std::vector<Vector2> thin_out(const std::vector<Vector2>& points, std::size_t most, double least_step_m) {
  constexpr int kMostRounds = 40;
  if (points.empty() || most == 0) return {};
  Vector2 low = points.front(), high = low;
  for (const Vector2& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  // Surfaces are lines: the squares that they touch are fewer as the squares are larger.
  double step = least_step_m;
  std::vector<Vector2> kept = one_a_square(points, step, low, high);
  for (int round = 0; round < kMostRounds && kept.size() > most; ++round) {
    step *= std::max(1.05, static_cast<double>(kept.size()) / static_cast<double>(most));
    kept = one_a_square(points, step, low, high);
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
