// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>

#include "base/number_text.h"

namespace dynslam {

/// How long to draw a scale bar: the longest of 1, 2, 5 times a power of ten that is at most `limit`
/// (above 0), in the unit of `limit`.
inline double round_length(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= limit) return digit * power;
  }
  return power;
}

/// What stands beside it: "0.5 m", "20 m", "2 km".
inline std::string length_label(double length_m) {
  return length_m >= 1000.0 ? shortest_text(std::round(length_m / 1000.0)) + " km"
                            : shortest_text(length_m) + " m";
}

}  // namespace dynslam
