// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

namespace dynslam {

/// No lidar has as many; it keeps a damaged count from becoming memory (12 bytes a beam).
inline constexpr std::size_t kMaxBeams = 1 << 21;

/// A raw reading as Beam::range_m wants it: finite and positive, +inf (no return) or NaN (invalid).
inline float clean_range(float range_m, float min_m, float max_m) {
  if (range_m >= max_m) return std::numeric_limits<float>::infinity();
  if (range_m > 0.0F && range_m >= min_m) return range_m;
  return std::numeric_limits<float>::quiet_NaN();
}

/// Whether the angles of a fan can be those of a lidar: a few turns at most. False for NaN.
inline bool is_plausible_fan(double first_rad, double step_rad, std::size_t beams) {
  constexpr double kMost = 1e3;
  return std::abs(first_rad) < kMost && std::abs(step_rad * static_cast<double>(beams)) < kMost;
}

}  // namespace dynslam
