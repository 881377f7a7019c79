// SPDX-License-Identifier: MIT
#include "drive/segment.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dynslam {
namespace {

Vector2 direction_of(const Segment& s) { return (s.to - s.from) / s.length_m(); }

}  // namespace

Span span_along(const Segment& line, const Segment& segment) {
  const Vector2 along = direction_of(line);
  const double a = along.dot(segment.from - line.from), b = along.dot(segment.to - line.from);
  return {std::min(a, b), std::max(a, b)};
}

Segment on_line(const Segment& line, const Span& span) {
  const Vector2 along = direction_of(line);
  return {line.from + span.low * along, line.from + span.high * along};
}

double off_line_m(const Segment& line, const Vector2& point) {
  const Vector2 along = direction_of(line), there = point - line.from;
  return std::abs(along.x() * there.y() - along.y() * there.x());
}

std::optional<Segment> joined(const Segment& a, const Segment& b, double aside_m, double gap_m) {
  const bool a_is_longer = a.length_m() >= b.length_m();
  const Segment& line = a_is_longer ? a : b;
  Segment other = a_is_longer ? b : a;
  if (std::max(off_line_m(line, other.from), off_line_m(line, other.to)) > aside_m) return std::nullopt;
  const Vector2 along = direction_of(line);
  if (along.dot(other.to - other.from) < 0.0) std::swap(other.from, other.to);
  const Span there = span_along(line, other);
  if (there.low > line.length_m() + gap_m || there.high < -gap_m) return std::nullopt;
  return Segment{there.low < 0.0 ? other.from : line.from, there.high > line.length_m() ? other.to : line.to};
}

}  // namespace dynslam
