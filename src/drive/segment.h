// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/pose2.h"

namespace dynslam {

/// A straight piece of something.
struct Segment {
  Vector2 from, to;
  double length_m() const { return (to - from).norm(); }
};

/// Where another segment lies along one, from where that begins; along the line beyond its ends too.
struct Span {
  double low, high;
};
/// REQUIRES of `line`: a length over 0, here and below.
Span span_along(const Segment& line, const Segment& segment);
Segment on_line(const Segment& line, const Span& span);
double off_line_m(const Segment& line, const Vector2& point);

/// Both as one, from the one's outermost end to the other's, when they are of one straight thing: the shorter
/// one is nowhere farther than `aside_m` from the longer one's line, and not more than `gap_m` is between
/// them.
std::optional<Segment> joined(const Segment& a, const Segment& b, double aside_m, double gap_m);

}  // namespace dynslam
