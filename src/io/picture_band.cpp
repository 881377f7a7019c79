// SPDX-License-Identifier: MIT
#include "io/picture_band.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr Rgb kHaloColour{255, 255, 255};

std::uint8_t mix(std::uint8_t a, std::uint8_t b, float t) {
  return static_cast<std::uint8_t>(std::lround(static_cast<float>(a) + t * static_cast<float>(b - a)));
}

// Clamped before the cast: a point far outside the picture must not overflow an int.
int first_pixel(float v, int limit) {
  return static_cast<int>(std::clamp(std::floor(v), 0.0F, static_cast<float>(limit)));
}

/// Share of the way from a to b at which the segment is nearest to (x, y).
float nearest_share(const StrokePoint& a, const StrokePoint& b, float x, float y) {
  const float dx = b.x - a.x, dy = b.y - a.y;
  const float length2 = dx * dx + dy * dy;
  return length2 > 0.0F ? std::clamp(((x - a.x) * dx + (y - a.y) * dy) / length2, 0.0F, 1.0F) : 0.0F;
}

}  // namespace

Rgb mix(Rgb a, Rgb b, float t) { return {mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)}; }

PictureBand::PictureBand(int width, int max_rows)
    : width_(width),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(max_rows)),
      cover_(pixels_.size()) {}

void PictureBand::move_to(int first_row, int rows) {
  first_row_ = first_row;
  rows_ = rows;
}

void PictureBand::draw(const Stroke& stroke) {
  if (stroke.points.empty()) return;
  const float radius_px = stroke.width_px / 2.0F;
  if (stroke.halo_px > 0.0F) draw_shape(stroke, radius_px + stroke.halo_px, &kHaloColour);
  draw_shape(stroke, radius_px, nullptr);
}

void PictureBand::draw_shape(const Stroke& stroke, float radius_px, const Rgb* single_colour) {
  const std::vector<StrokePoint>& points = stroke.points;
  bool any = cover_segment(points.front(), points.front(), radius_px);
  for (std::size_t i = 1; i < points.size(); ++i) any |= cover_segment(points[i - 1], points[i], radius_px);
  if (any) blend_cover(single_colour);
}

// The middle of pixel (x, y) is at (x + 0.5, y + 0.5).
bool PictureBand::cover_segment(const StrokePoint& a, const StrokePoint& b, float radius_px) {
  const float reach = radius_px + 1.0F;
  const int top = std::max(first_pixel(std::min(a.y, b.y) - reach, first_row_ + rows_), first_row_);
  const int bottom = first_pixel(std::max(a.y, b.y) + reach + 1.0F, first_row_ + rows_);
  const int left = first_pixel(std::min(a.x, b.x) - reach, width_);
  const int right = first_pixel(std::max(a.x, b.x) + reach + 1.0F, width_);
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const float px = static_cast<float>(x) + 0.5F, py = static_cast<float>(y) + 0.5F;
      const float t = nearest_share(a, b, px, py);
      const float distance = std::hypot(px - (a.x + t * (b.x - a.x)), py - (a.y + t * (b.y - a.y)));
      const float share = std::clamp(radius_px + 0.5F - distance, 0.0F, 1.0F);
      const auto covered = static_cast<std::uint8_t>(std::lround(share * 255.0F));
      Cover& cover = cover_[offset(y) + static_cast<std::size_t>(x)];
      if (covered > 0 && covered >= cover.share)
        cover = {covered, mix(a.colour, b.colour, t)};  // the later is on top
    }
  }
  return top < bottom && left < right;
}

void PictureBand::blend_cover(const Rgb* single_colour) {
  const std::size_t count = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(width_);
  for (std::size_t i = 0; i < count; ++i) {
    Cover& cover = cover_[i];
    if (cover.share == 0) continue;
    const Rgb colour = single_colour != nullptr ? *single_colour : cover.colour;
    pixels_[i] = mix(pixels_[i], colour, static_cast<float>(cover.share) / 255.0F);
    cover = {};
  }
}

}  // namespace dynslam
