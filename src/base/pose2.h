// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "base/angles.h"

namespace dynslam {

using Vector2 = Eigen::Vector2d;

/// A rigid motion of the plane. Named `a_T_b`, it maps points of frame b into frame a:
/// `p_a = a_T_b * p_b`, and `a_T_c = a_T_b * b_T_c`.
struct Pose2 {
  double x = 0.0;    ///< metres
  double y = 0.0;    ///< metres
  double yaw = 0.0;  ///< radians, kept in [-pi, pi] by the operations below

  Vector2 translation() const { return {x, y}; }
  Pose2 inverse() const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {-c * x - s * y, s * x - c * y, -yaw};
  }
  bool operator==(const Pose2&) const = default;
};

inline Pose2 operator*(const Pose2& a, const Pose2& b) {
  const double c = std::cos(a.yaw), s = std::sin(a.yaw);
  return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, wrap_angle(a.yaw + b.yaw)};
}

inline Vector2 operator*(const Pose2& a, const Vector2& p) {
  const double c = std::cos(a.yaw), s = std::sin(a.yaw);
  return {a.x + c * p.x() - s * p.y(), a.y + s * p.x() + c * p.y()};
}

/// The pose a share `t` (0 = a, 1 = b, beyond = extrapolated) of the way from a to b; the turn is the
/// shortest.
inline Pose2 interpolate(const Pose2& a, const Pose2& b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), wrap_angle(a.yaw + t * turn(a.yaw, b.yaw))};
}

inline bool is_finite(const Pose2& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.yaw);
}

}  // namespace dynslam
