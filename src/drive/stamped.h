// SPDX-License-Identifier: MIT
#pragma once

#include "base/time.h"

namespace dynslam {

/// A value and when it was read.
template <class T>
struct Stamped {
  Time stamp;
  T value;
};

/// A driver estimates when a sample was taken, and may be so much ahead; further ahead is nonsense.
constexpr Duration kStampJitter = std::chrono::milliseconds(20);

/// Whether a stamp is neither from the future nor older than this.
constexpr bool is_fresh(Time stamp, Time now, Duration oldest) {
  return stamp <= now + kStampJitter && now - stamp <= oldest;
}

}  // namespace dynslam
