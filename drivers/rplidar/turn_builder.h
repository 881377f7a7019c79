// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "base/scan.h"
#include "drivers/rplidar/packet_stream.h"

namespace dynslam::rplidar {

/// Puts beams together to whole turns, in the order they were measured, their angles counter-clockwise and
/// going on past pi instead of wrapping. A turn with a hole in it is no turn: what stands there would be
/// missed.
class TurnBuilder {
 public:
  explicit TurnBuilder(const LidarMount& mount) : mount_(mount) {}

  /// Takes the next beam. Returns the turn that ended before it, if one did.
  std::optional<Scan> add(const Sample& sample);
  /// Turns that had a hole, after the first whole one.
  std::uint64_t holed() const { return holed_; }

 private:
  void begin(const Sample& sample);
  std::optional<Scan> finish();

  LidarMount mount_;
  Scan scan_;
  bool whole_ = false;  ///< so far
  bool any_whole_ = false;
  float turned_deg_ = 0.0F;
  std::size_t usual_beams_ = 0;
  std::uint64_t holed_ = 0;
};

}  // namespace dynslam::rplidar
