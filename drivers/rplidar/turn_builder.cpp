// SPDX-License-Identifier: MIT
#include "drivers/rplidar/turn_builder.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace dynslam::rplidar {
namespace {

/// More than corrections can differ from node to node.
constexpr float kHole_deg = 15.0F;
constexpr float kTurn_deg = 360.0F;
/// No lidar takes more in a turn: this one's motor stands.
constexpr std::size_t kMostBeams = 20000;

}  // namespace

std::optional<Scan> TurnBuilder::add(const Sample& sample) {
  std::optional<Scan> done;
  whole_ = whole_ && !sample.after_gap;
  if (sample.anew || scan_.beams.size() >= kMostBeams) {
    begin(sample);
  } else if (sample.turned_deg < turned_deg_ - 0.5F * kTurn_deg) {
    done = finish();
    begin(sample);
  } else if (scan_.beams.empty()) {
    begin(sample);
  } else if (sample.turned_deg > turned_deg_ + kHole_deg) {
    whole_ = false;
  }
  turned_deg_ = sample.turned_deg;
  // What is known of the time gets better all the time, and may step back a little.
  const float after_s = static_cast<float>(to_seconds(sample.time - scan_.stamp));
  const float least_s = scan_.beams.empty() ? 0.0F : scan_.beams.back().time_s;
  const auto angle_rad = static_cast<float>(radians(-double{sample.angle_deg}));
  scan_.beams.push_back({angle_rad, sample.range_m, std::max(least_s, after_s)});
  return done;
}

void TurnBuilder::begin(const Sample& sample) {
  scan_ = {sample.time, {}, mount_};
  scan_.beams.reserve(usual_beams_ + usual_beams_ / 16);
  whole_ = std::abs(sample.turned_deg) < kHole_deg && !sample.after_gap;
}

std::optional<Scan> TurnBuilder::finish() {
  if (!whole_ || turned_deg_ < kTurn_deg - kHole_deg) {
    holed_ += any_whole_ ? 1 : 0;
    return std::nullopt;
  }
  any_whole_ = true;
  usual_beams_ = scan_.beams.size();
  return std::move(scan_);
}

}  // namespace dynslam::rplidar
