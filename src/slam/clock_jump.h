// SPDX-License-Identifier: MIT
#pragma once

#include "base/time.h"

namespace dynslam {

/// Whether a stamp lies so far before the newest one that the clock itself must have been set back. A little
/// before is only disorder.
inline bool is_clock_jump(Time newest, Time next) { return next + std::chrono::seconds(1) < newest; }

}  // namespace dynslam
