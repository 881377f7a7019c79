// SPDX-License-Identifier: MIT
#pragma once

#include "base/twist.h"

namespace dynslam {

/// Drives back the way it came, slowly: the last motion, reversed. Pure; one thread.
class BackOff {
 public:
  /// What is driven while there is nothing to back off from.
  void note(const Twist& driven) {
    if (is_moving(driven)) came_ = driven;
  }
  /// How it came; zero: it never moved.
  const Twist& came() const { return came_; }
  /// What to drive.
  Twist twist() const;

 private:
  Twist came_;
};

}  // namespace dynslam
