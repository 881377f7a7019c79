// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/time.h"
#include "drivers/bno055/protocol.h"

namespace dynslam::bno055 {

/// Whether a reading can follow the last one that was believed: the robot has mass, so that its turning rate
/// changes only so fast, and the orientation goes by the rate. Bits that flip on the wires and still leave a
/// quaternion of length 1 are found so. The longer nothing was believed, the more is possible.
class MotionCheck {
 public:
  /// Believes it, or says what is wrong. REQUIRES: stamps in order, `motion` sound by itself.
  Nonsense check(Time stamp, const Motion& motion);
  /// The next reading is believed, as after a new start.
  void forget() { last_.reset(); }

 private:
  struct Stamped {
    Time stamp;
    Motion motion;
  };
  std::optional<Stamped> last_;
};

}  // namespace dynslam::bno055
