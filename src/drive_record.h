// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/pose2.h"
#include "robot/ports.h"

namespace dynslam {

/// How a robot that drives itself drives: what people notice. Looked at twenty times a second.
class DriveRecord {
 public:
  void note(Time now, const Ports& ports);

  /// The longest that it stood though it had a route.
  double longest_wait_s() const { return longest_wait_s_; }
  /// How often it turned the other way, for each metre of its way.
  double reversals_per_m() const { return way_m_ > 0.0 ? reversals_ / way_m_ : 0.0; }
  /// By its own map.
  double way_m() const { return way_m_; }

 private:
  std::optional<Time> stands_since_;
  double longest_wait_s_ = 0.0, way_m_ = 0.0;
  int reversals_ = 0;
  double turns_radps_ = 0.0;  ///< the last turn that could be felt
  std::optional<Pose2> pose_;
};

}  // namespace dynslam
