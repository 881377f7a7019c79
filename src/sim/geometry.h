// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/pose2.h"

namespace dynslam {

/// Corners in order, the last joined to the first.
using Polygon = std::vector<Vector2>;

inline double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

inline Vector2 unit(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

inline Vector2 nearest_on_segment(const Vector2& p, const Vector2& from, const Vector2& to) {
  const Vector2 along = to - from;
  const double length2 = along.squaredNorm();
  if (length2 == 0) return from;
  return from + std::clamp((p - from).dot(along) / length2, 0.0, 1.0) * along;
}

inline double distance_to_segment(const Vector2& p, const Vector2& from, const Vector2& to) {
  return (p - nearest_on_segment(p, from, to)).norm();
}

/// Whether two segments cross within both; touching ends and parallel ones do not count.
inline bool segments_cross(const Vector2& a, const Vector2& b, const Vector2& c, const Vector2& d) {
  const auto opposite = [](double one, double other) {
    return (one > 0 && other < 0) || (one < 0 && other > 0);
  };
  return opposite(cross(b - a, c - a), cross(b - a, d - a)) &&
         opposite(cross(d - c, a - c), cross(d - c, b - c));
}

inline double distance_between_segments(const Vector2& a, const Vector2& b, const Vector2& c,
                                        const Vector2& d) {
  if (segments_cross(a, b, c, d)) return 0.0;
  return std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d), distance_to_segment(c, a, b),
                   distance_to_segment(d, a, b)});
}

/// By counting the edges to the right.
inline bool is_inside(const Vector2& p, const Polygon& polygon) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vector2 &a = polygon[i], &b = polygon[j];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

/// A rectangle about a pose, x along `length_m`.
inline Polygon rectangle(const Pose2& middle, double length_m, double width_m) {
  const double x = length_m / 2, y = width_m / 2;
  return {middle * Vector2(-x, -y), middle * Vector2(x, -y), middle * Vector2(x, y), middle * Vector2(-x, y)};
}

/// A strip of a width along a segment, longer by `overhang_m` at both ends. REQUIRES: the ends differ.
inline Polygon strip(const Vector2& from, const Vector2& to, double width_m, double overhang_m = 0.0) {
  const Vector2 along = to - from, middle = (from + to) / 2;
  return rectangle({middle.x(), middle.y(), std::atan2(along.y(), along.x())}, along.norm() + 2 * overhang_m,
                   width_m);
}

}  // namespace dynslam
