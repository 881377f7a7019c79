// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "base/config_field.h"
#include "base/pose2.h"

namespace dynslam {

/// Section [body] of the configuration: the rectangle that the robot fills on the floor, wheels included, its
/// middle over the middle of the axle. The defaults are a MonsterBorg's.
struct BodyConfig {
  double length_m = 0.28;
  double width_m = 0.24;

  double half_length_m() const { return 0.5 * length_m; }
  double half_width_m() const { return 0.5 * width_m; }
  /// It may be smaller than it is said to be: what is seen this deep in it is beside it still.
  static constexpr double kMayBeSmaller_m = 0.02;
  /// From the middle to a corner: what a turn on the spot sweeps.
  double radius_m() const { return std::hypot(half_length_m(), half_width_m()); }

  /// Whether a place from the robot is so deep inside of it, or deeper.
  bool contains(const Vector2& p, double depth_m = 0.0) const {
    return std::abs(p.x()) <= half_length_m() - depth_m && std::abs(p.y()) <= half_width_m() - depth_m;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"length_m", "length of the robot from bumper to bumper", 0.05, 3.0}, self.length_m);
    visit(Field{"width_m", "width of the robot over its wheels", 0.05, 3.0}, self.width_m);
  }
};

}  // namespace dynslam
