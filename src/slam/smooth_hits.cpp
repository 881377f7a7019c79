// SPDX-License-Identifier: MIT
#include "slam/smooth_hits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace dynslam {
namespace {

using Floats4 = float __attribute__((vector_size(16)));
using Bytes4 = std::uint8_t __attribute__((vector_size(4)));

/// Weights of the four cells around a position, and their first and second derivatives.
struct Spline {
  Floats4 value, slope, curve;
};

/// The uniform cubic B-spline at a position `t` (0 to 1) past the second cell's centre.
Spline spline_at(float t) {
  const float u = 1 - t;
  const float t2 = t * t, t3 = t2 * t;
  return {Floats4{u * u * u, 3 * t3 - 6 * t2 + 4, 3 * (t + t2 - t3) + 1, t3} / 6.0F,
          Floats4{-u * u, 3 * t2 - 4 * t, 1 + 2 * t - 3 * t2, t2} / 2.0F,
          Floats4{u, 3 * t - 2, 1 - 3 * t, t}};
}

constexpr int kSplineSteps = 256;

std::array<Spline, kSplineSteps + 1> make_splines() {
  std::array<Spline, kSplineSteps + 1> table;
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = spline_at(static_cast<float>(i) / kSplineSteps);
  return table;
}
const std::array<Spline, kSplineSteps + 1> kSplines = make_splines();

/// The same from a table: a step is a 256th of a cell, far below what the map can tell.
inline const Spline& spline_near(float t) {
  return kSplines[static_cast<std::size_t>(static_cast<int>(t * kSplineSteps + 0.5F))];
}

/// The sums of the lanes of four vectors, as one vector.
inline Floats4 lane_sums(Floats4 a, Floats4 b, Floats4 c, Floats4 d) {
  const Floats4 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Floats4 cd = __builtin_shufflevector(c, d, 0, 4, 1, 5) + __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

struct Patch {
  Floats4 rows[4];  ///< 0 to 255
  float tx, ty;     ///< position past the second column's and row's centres
};

/// The 4 x 4 cells around a position; false when the window does not hold them all, or when all are empty.
inline bool load_patch(const HitWindow& window, float x, float y, Patch& patch) {
  if (!(x >= 2.0F && y >= 2.0F && x < 1e6F && y < 1e6F)) return false;
  const int centre_x = static_cast<int>(x - 0.5F), centre_y = static_cast<int>(y - 0.5F);
  const int column = centre_x - 1, row = centre_y - 1;
  if (!window.contains(column, row) || !window.contains(column, row + 3)) return false;
  patch.tx = x - 0.5F - static_cast<float>(centre_x);
  patch.ty = y - 0.5F - static_cast<float>(centre_y);
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

inline Floats4 blend(const Patch& p, Floats4 w) {
  return p.rows[0] * w[0] + p.rows[1] * w[1] + p.rows[2] * w[2] + p.rows[3] * w[3];
}

/// Sums over the points, in floats: the upper triangle of the information, the gradient, the score.
struct Sums {
  float xx = 0, xy = 0, xt = 0, yy = 0, yt = 0, tt = 0, gx = 0, gy = 0, gt = 0, score = 0;

  /// `nx`, `ny`: the point's surface runs across this direction, and tells of nothing else; 0, 0: not known.
  void add(const Patch& patch, float rx, float ry, float weight, float nx, float ny) {
    const Spline& along_x = spline_near(patch.tx);
    const Spline& along_y = spline_near(patch.ty);
    const Floats4 value = blend(patch, along_y.value), rise = blend(patch, along_y.slope),
                  bend = blend(patch, along_y.curve);
    const Floats4 first =
        lane_sums(value * along_x.value, value * along_x.slope, rise * along_x.value, value * along_x.curve) /
        255.0F;
    const float f = first[0], fx = first[1], fy = first[2], fxx = first[3];
    if (f < 1e-3F) return;
    const Floats4 rest = lane_sums(rise * along_x.slope, bend * along_x.value, Floats4{}, Floats4{}) / 255.0F;
    const float fxy = rest[0], fyy = rest[1];
    const float a = fx * fx / f - fxx, b = fx * fy / f - fxy, c = fy * fy / f - fyy;
    score += weight * f;
    if (nx != 0 || ny != 0) {
      const float slope = weight * (fx * nx + fy * ny);
      const float curve = weight * std::max(0.0F, a * nx * nx + 2 * b * nx * ny + c * ny * ny);
      add_curvature(curve * nx * nx, curve * nx * ny, curve * ny * ny, rx, ry);
      gx += slope * nx, gy += slope * ny, gt += slope * (ny * rx - nx * ry);
      return;
    }
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
  if (!load_patch(window, x, y, patch)) return 0.0F;
  const Floats4 value = blend(patch, spline_near(patch.ty).value) * spline_near(patch.tx).value;
  return (value[0] + value[1] + value[2] + value[3]) / 255.0F;
}

HitFit fit_to_hits(const HitWindow& window, std::span<const MatchPoint> points, const Pose2& window_T_robot) {
  const auto c = static_cast<float>(std::cos(window_T_robot.yaw)),
             s = static_cast<float>(std::sin(window_T_robot.yaw));
  const auto x0 = static_cast<float>(window_T_robot.x), y0 = static_cast<float>(window_T_robot.y);
  Sums sums;
  Patch patch;
  for (const MatchPoint& p : points) {
    const float rx = c * p.x - s * p.y, ry = s * p.x + c * p.y;
    if (!load_patch(window, x0 + rx, y0 + ry, patch)) continue;
    sums.add(patch, rx, ry, p.weight, c * p.nx - s * p.ny, s * p.nx + c * p.ny);
  }
  HitFit fit;
  fit.information << sums.xx, sums.xy, sums.xt, sums.xy, sums.yy, sums.yt, sums.xt, sums.yt, sums.tt;
  fit.gradient << sums.gx, sums.gy, sums.gt;
  fit.score = sums.score;
  return fit;
}

}  // namespace dynslam
