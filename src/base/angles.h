// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

namespace dynslam {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2.0 * std::numbers::pi;

constexpr double radians(double degrees) { return degrees * kPi / 180.0; }
constexpr double degrees(double radians) { return radians * 180.0 / kPi; }

/// The same angle in [-pi, pi]. Non-finite in, NaN out.
inline double wrap_angle(double angle) { return std::remainder(angle, kTwoPi); }

/// The shortest turn that leads from `from` to `to`, in [-pi, pi].
inline double turn(double from, double to) { return wrap_angle(to - from); }

}  // namespace dynslam
