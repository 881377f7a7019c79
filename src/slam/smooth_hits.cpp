// SPDX-License-Identifier: MIT
#include "slam/smooth_hits.h"

#include <cmath>
#include <cstring>

namespace dynslam {
namespace {

using Floats4 = float __attribute__((vector_size(16)));
using Bytes4 = std::uint8_t __attribute__((vector_size(4)));

/// Weights of the four cells around a position `t` (0 to 1) past the second one's centre.
Floats4 spline(float t) {
  const float u = 1 - t;
  const float t2 = t * t, t3 = t2 * t;
  return Floats4{u * u * u, 3 * t3 - 6 * t2 + 4, 3 * (t + t2 - t3) + 1, t3} / 6.0F;
}

/// Their derivatives.
Floats4 spline_slope(float t) {
  const float u = 1 - t;
  return Floats4{-u * u, 3 * t * t - 4 * t, 1 + 2 * t - 3 * t * t, t * t} / 2.0F;
}

/// Their second derivatives.
Floats4 spline_curve(float t) { return Floats4{1 - t, 3 * t - 2, 1 - 3 * t, t}; }

float sum(Floats4 v) { return (v[0] + v[1]) + (v[2] + v[3]); }

struct Patch {
  Floats4 rows[4];  ///< 0 to 255
  float tx, ty;     ///< position past the second column's and row's centres
};

/// The 4 x 4 cells around a position; false when the window does not hold them all, or when all are empty.
bool load_patch(const HitWindow& window, float x, float y, Patch& patch) {
  const float left = std::floor(x - 0.5F), low = std::floor(y - 0.5F);
  const int column = static_cast<int>(left) - 1, row = static_cast<int>(low) - 1;
  if (!window.contains(column, row) || !window.contains(column, row + 3)) return false;
  patch.tx = x - 0.5F - left;
  patch.ty = y - 0.5F - low;
  const std::uint8_t* at = window.data() + static_cast<std::ptrdiff_t>(row) * window.stride() + column;
  std::uint32_t any = 0;
  for (int i = 0; i < 4; ++i, at += window.stride()) {
    Bytes4 bytes;
    std::uint32_t word = 0;
    std::memcpy(&bytes, at, sizeof bytes);
    std::memcpy(&word, at, sizeof word);
    any |= word;
    patch.rows[i] = __builtin_convertvector(bytes, Floats4);
  }
  return any != 0;
}

Floats4 blend(const Patch& p, Floats4 w) { return p.rows[0] * w[0] + p.rows[1] * w[1] + p.rows[2] * w[2] + p.rows[3] * w[3]; }

/// Sums over the points, in floats: the upper triangle of the information, the gradient, the score.
struct Sums {
  float xx = 0, xy = 0, xt = 0, yy = 0, yt = 0, tt = 0, gx = 0, gy = 0, gt = 0, score = 0;

  void add(const Patch& patch, float rx, float ry, float weight) {
    const Floats4 wx = spline(patch.tx), dx = spline_slope(patch.tx), cx = spline_curve(patch.tx);
    const Floats4 value = blend(patch, spline(patch.ty)) / 255.0F;
    const Floats4 rise = blend(patch, spline_slope(patch.ty)) / 255.0F;
    const Floats4 bend = blend(patch, spline_curve(patch.ty)) / 255.0F;
    const float f = sum(value * wx), fx = sum(value * dx), fy = sum(rise * wx);
    if (f < 1e-3F) return;
    const float a = fx * fx / f - sum(value * cx), b = fx * fy / f - sum(rise * dx), c = fy * fy / f - sum(bend * wx);
    // Only what curves down counts: the larger eigenvalue is kept when the smaller is negative.
    const float mean = 0.5F * (a + c), spread = std::sqrt(0.25F * (a - c) * (a - c) + b * b);
    if (mean + spread <= 0) {
      // A dent: it pushes, but says nothing of how far.
    } else if (mean - spread >= 0) {
      add_curvature(weight * a, weight * b, weight * c, rx, ry);
    } else {
      const float kept = weight * (mean + spread) / (2 * spread);  // eigenvalue times projector on its vector
      add_curvature(kept * (a - mean + spread), kept * b, kept * (c - mean + spread), rx, ry);
    }
    gx += weight * fx, gy += weight * fy, gt += weight * (fy * rx - fx * ry);
    score += weight * f;
  }

  /// Carries the curvature in x and y over to the turn, which moves a point by (-ry, rx) a radian.
  void add_curvature(float a, float b, float c, float rx, float ry) {
    const float at = b * rx - a * ry, ct = c * rx - b * ry;
    xx += a, xy += b, yy += c, xt += at, yt += ct, tt += ct * rx - at * ry;
  }
};

}  // namespace

float smooth_hit(const HitWindow& window, float x, float y) {
  Patch patch;
  return load_patch(window, x, y, patch) ? sum(blend(patch, spline(patch.ty)) * spline(patch.tx)) / 255.0F : 0.0F;
}

HitFit fit_to_hits(const HitWindow& window, std::span<const MatchPoint> points, const Pose2& window_T_robot) {
  const auto c = static_cast<float>(std::cos(window_T_robot.yaw)), s = static_cast<float>(std::sin(window_T_robot.yaw));
  const auto x0 = static_cast<float>(window_T_robot.x), y0 = static_cast<float>(window_T_robot.y);
  Sums sums;
  Patch patch;
  for (const MatchPoint& p : points) {
    const float rx = c * p.x - s * p.y, ry = s * p.x + c * p.y;
    if (load_patch(window, x0 + rx, y0 + ry, patch)) sums.add(patch, rx, ry, p.weight);
  }
  HitFit fit;
  fit.information << sums.xx, sums.xy, sums.xt, sums.xy, sums.yy, sums.yt, sums.xt, sums.yt, sums.tt;
  fit.gradient << sums.gx, sums.gy, sums.gt;
  fit.score = sums.score;
  return fit;
}

}  // namespace dynslam
