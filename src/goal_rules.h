// SPDX-License-Identifier: MIT
#pragma once

namespace dynslam {

/// By which a simulated robot's goals are judged: places on the floor so far from each other are looked at,
inline constexpr double kFloorStep_m = 0.1;
/// and a goal that is too tight may be given up for one so near to it.
inline constexpr double kNearby_m = 0.35;

}  // namespace dynslam
