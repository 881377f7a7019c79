// SPDX-License-Identifier: MIT
#include "sim/floor_look.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr std::uint8_t kMany = 255;
constexpr double kMostCells = 1e6;
constexpr double kShadow_m = 0.18;
constexpr double kPatternRange_m = 7.0;
const Colour kBareFloor = 0x9a958c;

/// The same number in [0, 1) for the same place.
float speckle(std::int32_t x, std::int32_t y) {
  auto h = static_cast<std::uint32_t>(x) * 0x85ebca6bU ^ static_cast<std::uint32_t>(y) * 0xc2b2ae35U;
  h ^= h >> 15;
  h *= 0x2c1b3c6dU;
  h ^= h >> 13;
  return static_cast<float>(h & 0xffffU) / 65536.0F;
}

std::int32_t whole(double x) { return static_cast<std::int32_t>(std::floor(x)); }

/// How light a pattern is at a place, about 1.
float pattern_at(FloorPattern pattern, const Vector2& p) {
  if (pattern == FloorPattern::kPlanks) {
    constexpr double kWidth = 0.14, kLength = 1.3;
    const std::int32_t row = whole(p.y() / kWidth);
    const double along = p.x() / kLength + 0.37 * row;
    const double side = p.y() / kWidth - row, end = (along - std::floor(along)) * kLength;
    if (side < 0.03 || end < 0.004) return 0.72F;
    return 0.93F + 0.14F * speckle(whole(along), row) +
           0.03F * speckle(whole(p.x() / 0.06), whole(p.y() / 0.008));
  }
  if (pattern == FloorPattern::kTiles) {
    constexpr double kSide = 0.3;
    const std::int32_t column = whole(p.x() / kSide), row = whole(p.y() / kSide);
    if (p.x() / kSide - column < 0.02 || p.y() / kSide - row < 0.02) return 0.80F;
    return 0.97F + 0.06F * speckle(column, row);
  }
  if (pattern == FloorPattern::kCarpet)
    return 0.92F + 0.16F * speckle(whole(p.x() / 0.012), whole(p.y() / 0.012));
  return 1.0F;
}

}  // namespace

Rgb rgb_of(Colour c) {
  return {static_cast<float>((c >> 16) & 255U), static_cast<float>((c >> 8) & 255U),
          static_cast<float>(c & 255U)};
}

FloorLook::FloorLook(const World& world, const std::vector<Surface>& fixed) : patches_(world.floors) {
  if (patches_.size() > kMany - 2) patches_.resize(kMany - 2);
  Vector2 low = world.world_T_start.translation(), high = low;
  for (const Surface& s : fixed) {
    low = low.cwiseMin(s.from);
    high = high.cwiseMax(s.from);
  }
  low_ = low.array() - 0.5;
  const Vector2 span = high.array() + 0.5 - low_.array();
  cell_m_ = std::max(cell_m_, std::sqrt(span.x() * span.y() / kMostCells));
  columns_ = static_cast<int>(span.x() / cell_m_) + 1;
  rows_ = static_cast<int>(span.y() / cell_m_) + 1;
  note_patches();
  darken_beside(fixed);
}

std::size_t FloorLook::cell_of(double x, double y) const {
  const int column = static_cast<int>(std::clamp((x - low_.x()) / cell_m_, 0.0, columns_ - 1.0));
  const int row = static_cast<int>(std::clamp((y - low_.y()) / cell_m_, 0.0, rows_ - 1.0));
  return static_cast<std::size_t>(row) * columns_ + column;
}

int FloorLook::patch_at(const Vector2& p) const {
  for (std::size_t i = patches_.size(); i > 0; --i) {
    if (is_inside(p, patches_[i - 1].outline)) return static_cast<int>(i);
  }
  return 0;
}

void FloorLook::note_patches() {
  patch_.assign(static_cast<std::size_t>(columns_) * rows_, 0);
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    Vector2 low = patches_[i].outline.front(), high = low;
    for (const Vector2& p : patches_[i].outline) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    for (double y = low.y(); y < high.y() + cell_m_; y += cell_m_) {
      for (double x = low.x(); x < high.x() + cell_m_; x += cell_m_) {
        const std::size_t cell = cell_of(x, y);
        const Vector2 middle = low_ + cell_m_ * Vector2(static_cast<double>(cell % columns_) + 0.5,
                                                        static_cast<double>(cell / columns_) + 0.5);
        if (is_inside(middle, patches_[i].outline)) patch_[cell] = static_cast<std::uint8_t>(i + 1);
      }
    }
  }
  for (const FloorPatch& patch : patches_) {  // their edges take a closer look
    for (std::size_t i = 0; i < patch.outline.size(); ++i) {
      const Vector2 from = patch.outline[i], along = patch.outline[(i + 1) % patch.outline.size()] - from;
      const double step = 0.5 * cell_m_ / std::max(along.norm(), cell_m_);
      for (double t = 0; t < 1; t += step) {
        for (int k = 0; k < 9; ++k) {
          const Vector2 p = from + t * along + cell_m_ * Vector2(k % 3 - 1, k / 3 - 1);
          patch_[cell_of(p.x(), p.y())] = kMany;
        }
      }
    }
  }
}

void FloorLook::darken_beside(const std::vector<Surface>& fixed) {
  light_.assign(patch_.size(), 255);
  for (const Surface& s : fixed) {
    if (s.low_m > 0.15) continue;
    const double reach = kShadow_m + s.radius_m;
    const Vector2 to = s.from + s.along;
    const Vector2 low = s.from.cwiseMin(to).array() - reach, high = s.from.cwiseMax(to).array() + reach;
    for (double y = low.y(); y < high.y(); y += cell_m_) {
      for (double x = low.x(); x < high.x(); x += cell_m_) {
        const double off = distance_to_segment({x, y}, s.from, s.radius_m > 0 ? s.from : to) - s.radius_m;
        if (off > kShadow_m) continue;
        const double share = std::max(0.0, off) / kShadow_m;
        auto& light = light_[cell_of(x, y)];
        light = std::min(light, static_cast<std::uint8_t>(255.0 * (0.62 + 0.38 * share * (2.0 - share))));
      }
    }
  }
}

Rgb FloorLook::at(const Vector2& p, double distance_m) const {
  const std::size_t cell = cell_of(p.x(), p.y());
  const int patch = patch_[cell] == kMany ? patch_at(p) : patch_[cell];
  const Rgb plain = rgb_of(patch > 0 ? patches_[patch - 1].colour : kBareFloor);
  // Light is smoothed between the four cells about the place.
  const double x = p.x() - cell_m_ / 2, y = p.y() - cell_m_ / 2;
  const double fx = (x - low_.x()) / cell_m_, fy = (y - low_.y()) / cell_m_;
  const auto tx = static_cast<float>(fx - std::floor(fx)), ty = static_cast<float>(fy - std::floor(fy));
  const auto light = [&](double dx, double dy) {
    return static_cast<float>(light_[cell_of(x + dx, y + dy)]);
  };
  const float below = light(0, 0) + tx * (light(cell_m_, 0) - light(0, 0));
  const float above = light(0, cell_m_) + tx * (light(cell_m_, cell_m_) - light(0, cell_m_));
  float shade = (below + ty * (above - below)) / 255.0F;
  const auto blur = static_cast<float>(distance_m / kPatternRange_m);
  if (patch > 0 && blur < 1)
    shade *= 1.0F + (1.0F - blur) * (pattern_at(patches_[patch - 1].pattern, p) - 1.0F);
  return plain * shade;
}

}  // namespace dynslam
