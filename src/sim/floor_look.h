// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sim/surface.h"

namespace dynslam {

/// Three channels of light, 0 to 255.
struct Rgb {
  float r = 0.0F, g = 0.0F, b = 0.0F;
  Rgb operator*(float share) const { return {r * share, g * share, b * share}; }
};

Rgb rgb_of(Colour colour);
inline Rgb mixed(const Rgb& a, const Rgb& b, float t) {
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

/// What the floor of a world looks like: its patches with their patterns, darker where things stand on it.
class FloorLook {
 public:
  FloorLook(const World& world, const std::vector<Surface>& fixed);

  /// As seen from `distance_m` away: far off, patterns blur.
  Rgb at(const Vector2& p, double distance_m) const;

 private:
  std::size_t cell_of(double x, double y) const;
  void note_patches();
  void darken_beside(const std::vector<Surface>& fixed);
  int patch_at(const Vector2& p) const;

  std::vector<FloorPatch> patches_;
  Vector2 low_ = Vector2::Zero();
  double cell_m_ = 0.02;
  int columns_ = 1, rows_ = 1;
  std::vector<std::uint8_t> patch_;  ///< by cell: 0 none, patch + 1, kMany where it takes a closer look
  std::vector<std::uint8_t> light_;  ///< by cell, 255: nothing near
};

}  // namespace dynslam
