// SPDX-License-Identifier: MIT
#include "drive/back_off.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr double kSpeed_mps = 0.06;
constexpr double kTurn_radps = 0.3;

}  // namespace

Twist BackOff::twist() const {
  const double v = std::abs(came_.v_mps), w = std::abs(came_.w_radps);
  if (v == 0.0 && w == 0.0) return {-kSpeed_mps, 0.0};
  const double share = std::min(v > 0.0 ? kSpeed_mps / v : 1e9, w > 0.0 ? kTurn_radps / w : 1e9);
  return {-share * came_.v_mps, -share * came_.w_radps};
}

}  // namespace dynslam
