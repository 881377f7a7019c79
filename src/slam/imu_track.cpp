// SPDX-License-Identifier: MIT
#include "slam/imu_track.h"

#include <algorithm>
#include <cmath>

#include "slam/clock_jump.h"

namespace dynslam {

void ImuTrack::add(const ImuSample& sample) {
  if (!samples_.empty() && is_clock_jump(samples_.back().stamp, sample.stamp)) samples_.clear();
  if (!samples_.empty() && sample.stamp <= samples_.back().stamp) {
    ++out_of_order_;
    return;
  }
  const double yaw = yaw_of(sample.world_q_robot);
  const double before = samples_.empty() ? yaw : samples_.back().yaw_rad;
  samples_.push_back({sample.stamp, before + turn(before, yaw)});
  smooth_last_but_one();
  while (samples_.front().stamp + kKept < sample.stamp) samples_.pop_front();
}

/// Compares the rates to both neighbours and takes the lower: only where both are beyond belief is the sample
/// itself at fault, and not the one before or after it (thesis 4.1.1).
void ImuTrack::smooth_last_but_one() {
  const std::size_t n = samples_.size();
  if (n < 3) return;
  const Heading& before = samples_[n - 3];
  Heading& here = samples_[n - 2];
  const Heading& after = samples_[n - 1];
  const double into = (here.yaw_rad - before.yaw_rad) / to_seconds(here.stamp - before.stamp);
  const double out_of = (after.yaw_rad - here.yaw_rad) / to_seconds(after.stamp - here.stamp);
  // Both steps large but in one direction is a fast turn, not a peak.
  if (std::min(std::abs(into), std::abs(out_of)) < kSpikeRate_radps || into * out_of > 0) return;
  here.yaw_rad = 0.5 * (before.yaw_rad + after.yaw_rad);
  ++spikes_;
}

std::optional<double> ImuTrack::heading_at(Time t) const {
  if (samples_.size() < 2 || t < samples_.front().stamp || t > samples_.back().stamp + kCarryOn)
    return std::nullopt;
  auto after = std::lower_bound(samples_.begin(), samples_.end(), t,
                                [](const Heading& h, Time time) { return h.stamp < time; });
  if (after == samples_.begin()) ++after;
  if (after == samples_.end()) --after;
  const Heading& a = *(after - 1);
  const Heading& b = *after;
  if (b.stamp - a.stamp > kLongestGap) return std::nullopt;
  const double share = to_seconds(t - a.stamp) / to_seconds(b.stamp - a.stamp);
  return a.yaw_rad + share * (b.yaw_rad - a.yaw_rad);
}

}  // namespace dynslam
