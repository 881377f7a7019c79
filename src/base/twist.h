// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace dynslam {

/// How the robot moves: along its x axis, and turning left about its middle axle.
struct Twist {
  double v_mps = 0.0;
  double w_radps = 0.0;
  bool operator==(const Twist&) const = default;
};

inline bool is_finite(const Twist& t) { return std::isfinite(t.v_mps) && std::isfinite(t.w_radps); }
inline bool is_moving(const Twist& t) { return t.v_mps != 0.0 || t.w_radps != 0.0; }

}  // namespace dynslam
