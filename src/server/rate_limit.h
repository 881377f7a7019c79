// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "base/time.h"

namespace dynslam {

/// So many a second, and up to `burst` at once: a bucket of tokens. Pure; one thread.
class RateLimit {
 public:
  RateLimit(double per_s, double burst) : per_s_(per_s), burst_(burst), tokens_(burst) {}

  /// Whether one more may pass now. A clock that runs backwards fills nothing.
  bool pass(Time now) {
    if (now > last_) tokens_ = std::min(burst_, tokens_ + per_s_ * to_seconds(now - last_));
    last_ = now;
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
  }

 private:
  double per_s_, burst_, tokens_;
  Time last_;
};

}  // namespace dynslam
