// SPDX-License-Identifier: MIT
#include "autopilot/glass_map.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace dynslam {
namespace {

constexpr Duration kRemembers = std::chrono::minutes(30);
constexpr std::size_t kMost = 256;
/// What lies so near to a pane's line, and begins so soon after it, is part of it.
constexpr double kSameLine_m = 0.1, kGap_m = 0.3;
constexpr double kNews_m = 0.1, kThick_m = 0.02;
/// Where the robot's middle is so near there is none.
constexpr double kDriven_m = 0.08;
constexpr double kLeast_m = 0.05;

bool is_at(const Segment& pane, const Vector2& place) {
  const Span at = span_along(pane, {place, place});
  return off_line_m(pane, place) < kDriven_m && at.low > 0.0 && at.high < pane.length_m();
}

}  // namespace

bool GlassMap::see(Time now, std::span<const Segment> panes_map, const Vector2& robot_map) {
  bool changed = std::erase_if(panes_, [&](const Pane& p) {
                   return now < p.seen || now - p.seen > kRemembers || is_at(p.at_map, robot_map);
                 }) > 0;
  for (const Segment& seen : panes_map) {
    if (seen.length_m() < kLeast_m || is_at(seen, robot_map)) continue;
    Segment whole = seen;
    double known_m = 0.0;
    std::erase_if(panes_, [&](const Pane& p) {
      const auto both = joined(whole, p.at_map, kSameLine_m, kGap_m);
      if (both) whole = *both;
      if (both && !p.is_doubted) known_m += p.at_map.length_m();
      return both.has_value();
    });
    changed = changed || whole.length_m() > known_m + kNews_m;
    panes_.push_back({whole, now});
  }
  if (panes_.size() > kMost) panes_.erase(panes_.begin(), panes_.end() - kMost);
  return changed;
}

bool GlassMap::doubt() {
  if (doubts_ || panes_.empty()) return false;
  doubts_ = true;
  for (Pane& p : panes_) p.is_doubted = true;
  return true;
}

bool GlassMap::trust() {
  doubts_ = false;
  bool changes = false;
  for (Pane& p : panes_) changes = std::exchange(p.is_doubted, false) || changes;
  return changes;
}

std::vector<std::vector<Vector2>> GlassMap::outlines_map() const {
  std::vector<std::vector<Vector2>> outlines;
  for (const Pane& pane : panes_) {
    if (pane.is_doubted) continue;
    const Segment& s = pane.at_map;
    const Vector2 along = (s.to - s.from) / s.length_m();
    const Vector2 aside = kThick_m * Vector2(-along.y(), along.x());
    outlines.push_back({s.from + aside, s.to + aside, s.to - aside, s.from - aside});
  }
  return outlines;
}

}  // namespace dynslam
