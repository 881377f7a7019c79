// SPDX-License-Identifier: MIT
#include "slam/pyramid_search.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace dynslam {
namespace {

constexpr int kLanes = MaxPyramid::kLanes;
/// A yaw lattice finer than this buys nothing and would not end.
constexpr int kMostHalfYaws = 4000;
constexpr int kNoYaw = std::numeric_limits<int>::min();

int cells(double metres, double cell_size_m) {
  return static_cast<int>(std::ceil(std::clamp(metres / cell_size_m - 1e-9, 0.0, 1e5)));
}

/// Cells beside a level that a shift within the window and a load can reach from a cell next to it.
int rim(int half, int level) { return (2 * half >> level) + 2 * kLanes; }

}  // namespace

PyramidSearch::PyramidSearch(const MaxPyramid& target, std::span<const Vector2> points_m, const Pose2& guess,
                             const SearchWindow& window, const PyramidSearchConfig& config)
    : target_(target), points_(points_m), guess_(guess), config_(config), placed_yaw_(kNoYaw) {
  const double cell = target.cell_size_m();
  double farthest = cell;
  for (const Vector2& p : points_m) farthest = std::max(farthest, p.norm());
  yaw_step_rad_ = cell / farthest;
  half_x_ = cells(window.half_x_m, cell);
  half_y_ = cells(window.half_y_m, cell);
  half_yaws_ = std::min(cells(std::min(window.half_yaw_rad, kPi), yaw_step_rad_), kMostHalfYaws);
  while (top_level_ + 1 < MaxPyramid::kLevels && (2 * half_x_ + 1) >> top_level_ >= kLanes) ++top_level_;
  placed_.resize(points_m.size());
  planes_.resize(static_cast<std::size_t>(top_level_) + 1);
  for (int level = 0; level <= top_level_; ++level) add_rim(level);
}

void PyramidSearch::add_rim(int level) {
  RimmedPlane& plane = planes_[static_cast<std::size_t>(level)];
  const MaxPyramid::Plane& from = target_.plane(level);
  const int rim_x = rim(half_x_, level), rim_y = rim(half_y_, level);
  plane.stride = from.width + 2 * rim_x;
  plane.yaw = kNoYaw;
  plane.offsets.resize(points_.size());
  const int rows = from.height + 2 * rim_y;
  plane.bytes.assign(static_cast<std::size_t>(plane.stride) * static_cast<std::size_t>(rows),
                     target_.unknown_worth());
  for (int y = -1; y < from.height; ++y) {
    std::memcpy(&plane.bytes[static_cast<std::size_t>((y + rim_y) * plane.stride + rim_x - 1)],
                &from.bytes[static_cast<std::size_t>(from.offset(-1, y))],
                static_cast<std::size_t>(from.width) + 1);
  }
}

/// Where the points at the yaw at hand lie when shifted by the least that the window has; all other shifts
/// are one step for all. A point that meets nothing but unknown cells stays in the rim.
void PyramidSearch::find_offsets(int level) {
  RimmedPlane& plane = planes_[static_cast<std::size_t>(level)];
  if (plane.yaw == placed_yaw_) return;
  plane.yaw = placed_yaw_;
  const int width = target_.plane(level).width, height = target_.plane(level).height;
  const int rim_x = rim(half_x_, level), rim_y = rim(half_y_, level);
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const int x = std::clamp((placed_[i].x - half_x_) >> level, -rim_x, width);
    const int y = std::clamp((placed_[i].y - half_y_) >> level, -rim_y, height);
    plane.offsets[i] = (y + rim_y) * plane.stride + x + rim_x;
  }
}

Pose2 PyramidSearch::pose_of(const LatticePose& p) const {
  const double cell = target_.cell_size_m();
  return {guess_.x + p.x * cell, guess_.y + p.y * cell, wrap_angle(guess_.yaw + p.yaw * yaw_step_rad_)};
}

std::uint32_t PyramidSearch::score(const LatticePose& p) const {
  const Pose2 turned = pose_of({0, 0, p.yaw});
  std::uint32_t sum = 0;
  for (const Vector2& q : points_) {
    const CellIndex c = target_.cell_of(turned * q);
    sum += target_.value(0, {c.x + p.x, c.y + p.y});
  }
  return sum;
}

void PyramidSearch::place_points(int yaw) {
  if (yaw == placed_yaw_) return;
  placed_yaw_ = yaw;
  const Pose2 pose = pose_of({0, 0, yaw});
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vector2& p = points_[i];
    placed_[i] = target_.cell_of({pose.x + c * p.x() - s * p.y(), pose.y + s * p.x() + c * p.y()});
  }
}

/// Bounds of 16 blocks at the yaw at hand.
PyramidSearch::Strip PyramidSearch::scored(int x, int y, int level) {
  ++result_.nodes;
  find_offsets(level);
  const RimmedPlane& plane = planes_[static_cast<std::size_t>(level)];
  const int shift = ((y + half_y_) >> level) * plane.stride + ((x + half_x_) >> level);
  Strip strip{x, y, placed_yaw_, level, score_16_shifts(plane.bytes.data() + shift, plane.offsets)};
  close_lanes(strip);
  return strip;
}

/// Takes out the blocks that lie outside the window or, in the second pass, too near to the best pose.
void PyramidSearch::close_lanes(Strip& strip) const {
  for (int m = 0; m < kLanes; ++m) {
    const bool outside = strip.x + (m << strip.level) > half_x_;
    if (outside || is_too_near(strip, m)) strip.bound[static_cast<std::size_t>(m)] = 0;
  }
}

bool PyramidSearch::is_too_near(const Strip& strip, int lane) const {
  if (!keep_away_) return false;
  if (std::abs(strip.yaw - keep_away_->yaw) * yaw_step_rad_ > config_.rival_rad) return false;
  const int side = 1 << strip.level;
  const int left = strip.x + lane * side - keep_away_->x, low = strip.y - keep_away_->y;
  const double dx = std::max(std::abs(left), std::abs(left + side - 1)),
               dy = std::max(std::abs(low), std::abs(low + side - 1));
  return Vector2(dx, dy).norm() * target_.cell_size_m() <= config_.rival_m;
}

std::vector<PyramidSearch::Strip> PyramidSearch::top_strips() {
  std::vector<Strip> strips;
  const int side = 1 << top_level_;
  for (int yaw = -half_yaws_; yaw <= half_yaws_; ++yaw) {
    place_points(yaw);
    for (int y = -half_y_; y <= half_y_; y += side) {
      for (int x = -half_x_; x <= half_x_; x += kLanes * side) {
        if (result_.nodes >= config_.max_nodes) return result_.out_of_budget = true, strips;
        strips.push_back(scored(x, y, top_level_));
      }
    }
  }
  return strips;
}

/// Looks into the blocks of a strip that can hold a better pose, the most promising first.
void PyramidSearch::descend(const Strip& strip) {
  if (strip.level == 0) return take(strip);
  struct Child {
    int half, row;
    std::uint32_t bound;
  };
  const int level = strip.level - 1, side = 1 << level;
  std::vector<Strip> children;
  for (int half = 0; half < 2; ++half) {
    const auto first = strip.bound.begin() + half * kLanes / 2;
    if (*std::max_element(first, first + kLanes / 2) <= floor_) continue;
    for (int row = 0; row < 2; ++row) {
      const int y = strip.y + row * side;
      if (y > half_y_) continue;
      if (result_.nodes >= config_.max_nodes) {
        result_.out_of_budget = true;
        return;
      }
      Strip child = scored(strip.x + half * kLanes * side, y, level);
      for (std::size_t m = 0; m < kLanes; ++m) {
        child.bound[m] = std::min(child.bound[m], *(first + static_cast<std::ptrdiff_t>(m / 2)));
      }
      children.push_back(child);
    }
  }
  search(children);
}

void PyramidSearch::take(const Strip& leaf) {
  for (int m = 0; m < kLanes; ++m) {
    const std::uint32_t sum = leaf.bound[static_cast<std::size_t>(m)];
    if (sum <= floor_) continue;
    floor_ = sum;
    found_ = LatticePose{leaf.x + m, leaf.y, leaf.yaw, sum};
  }
}

void PyramidSearch::search(const std::vector<Strip>& strips) {
  std::vector<std::pair<std::uint32_t, const Strip*>> order;
  order.reserve(strips.size());
  for (const Strip& s : strips) {
    if (s.most() > floor_) order.emplace_back(s.most(), &s);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [bound, strip] : order) {
    if (bound <= floor_ || result_.out_of_budget) break;
    place_points(strip->yaw);
    descend(*strip);
  }
}

/// The sum of a pose whose points score `evidence` more than unknown space, each.
std::uint32_t PyramidSearch::sum_with_evidence(double evidence) const {
  return static_cast<std::uint32_t>(
      std::max(0.0, (target_.unknown_worth() + evidence) * static_cast<double>(points_.size())));
}

PyramidSearchResult PyramidSearch::run() {
  result_ = {};
  found_.reset();
  keep_away_.reset();
  floor_ = sum_with_evidence(config_.least_evidence);
  if (points_.empty()) return result_;
  std::vector<Strip> strips = top_strips();
  if (!result_.out_of_budget) search(strips);
  result_.best = found_;
  if (!result_.best || result_.out_of_budget) return result_;

  keep_away_ = found_;
  found_.reset();
  const double evidence = result_.best->sum / static_cast<double>(points_.size()) - target_.unknown_worth();
  floor_ = sum_with_evidence(config_.rival_floor * evidence);
  for (Strip& s : strips) close_lanes(s);
  search(strips);
  result_.rival = found_;
  return result_;
}

}  // namespace dynslam
