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

float sum(Floats4 v) { return (v[0] + v[1]) + (v[2] + v[3]); }

struct Sample {
  float value = 0, slope_x = 0, slope_y = 0;
};

/// The 4 x 4 cells around a position, as floats 0 to 255; false when the window does not hold them all.
bool load_patch(const HitWindow& window, float x, float y, Floats4 (&rows)[4], float& tx, float& ty) {
  const float left = std::floor(x - 0.5F), low = std::floor(y - 0.5F);
  const int column = static_cast<int>(left) - 1, row = static_cast<int>(low) - 1;
  if (!window.contains(column, row) || !window.contains(column, row + 3)) return false;
  tx = x - 0.5F - left;
  ty = y - 0.5F - low;
  const std::uint8_t* at = window.data() + static_cast<std::ptrdiff_t>(row) * window.stride() + column;
  for (int i = 0; i < 4; ++i, at += window.stride()) {
    Bytes4 bytes;
    std::memcpy(&bytes, at, sizeof bytes);
    rows[i] = __builtin_convertvector(bytes, Floats4);
  }
  return true;
}

Sample sample(const HitWindow& window, float x, float y) {
  Floats4 rows[4];
  float tx = 0, ty = 0;
  if (!load_patch(window, x, y, rows, tx, ty)) return {};
  const Floats4 wy = spline(ty) / 255.0F, dy = spline_slope(ty) / 255.0F;
  const Floats4 columns = rows[0] * wy[0] + rows[1] * wy[1] + rows[2] * wy[2] + rows[3] * wy[3];
  const Floats4 rises = rows[0] * dy[0] + rows[1] * dy[1] + rows[2] * dy[2] + rows[3] * dy[3];
  const Floats4 wx = spline(tx);
  return {sum(columns * wx), sum(columns * spline_slope(tx)), sum(rises * wx)};
}

}  // namespace

float smooth_hit(const HitWindow& window, float x, float y) { return sample(window, x, y).value; }

HitFit fit_to_hits(const HitWindow& window, std::span<const MatchPoint> points, const Pose2& window_T_robot) {
  const auto c = static_cast<float>(std::cos(window_T_robot.yaw)), s = static_cast<float>(std::sin(window_T_robot.yaw));
  const auto x0 = static_cast<float>(window_T_robot.x), y0 = static_cast<float>(window_T_robot.y);
  // Sums of the upper triangle of J^T J and of J^T (1 - hit), J = (slope_x, slope_y, slope along the turn).
  float xx = 0, xy = 0, xt = 0, yy = 0, yt = 0, tt = 0, gx = 0, gy = 0, gt = 0;
  for (const MatchPoint& p : points) {
    const float rx = c * p.x - s * p.y, ry = s * p.x + c * p.y;
    const Sample at = sample(window, x0 + rx, y0 + ry);
    const float along_turn = at.slope_y * rx - at.slope_x * ry;
    const float wx = p.weight * at.slope_x, wy = p.weight * at.slope_y, wt = p.weight * along_turn;
    const float missing = 1 - at.value;
    xx += wx * at.slope_x, xy += wx * at.slope_y, xt += wx * along_turn;
    yy += wy * at.slope_y, yt += wy * along_turn, tt += wt * along_turn;
    gx += wx * missing, gy += wy * missing, gt += wt * missing;
  }
  HitFit fit;
  fit.information << xx, xy, xt, xy, yy, yt, xt, yt, tt;
  fit.gradient << gx, gy, gt;
  return fit;
}

}  // namespace dynslam
