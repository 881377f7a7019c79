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
  const Eigen::Quaterniond level_q_world(Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()));
  samples_.push_back({sample.stamp, before + turn(before, yaw), level_q_world * sample.world_q_robot});
  learn_usual_tilt(samples_.back());
  smooth_last_but_one();
  while (samples_.front().stamp + kKept < sample.stamp) samples_.pop_front();
}

/// A mean over all that was seen at first, over the last half minute later.
void ImuTrack::learn_usual_tilt(const Heading& heading) {
  constexpr double kMemory_s = 30.0;
  const double dt =
      samples_.size() < 2 ? 0.01 : to_seconds(heading.stamp - samples_[samples_.size() - 2].stamp);
  tilt_known_s_ = std::min(kMemory_s, tilt_known_s_ + std::min(dt, 0.1));
  usual_tilt_ = usual_tilt_.slerp(std::min(1.0, dt / tilt_known_s_), heading.tilt);
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

std::deque<ImuTrack::Heading>::const_iterator ImuTrack::after(Time t) const {
  if (samples_.size() < 2 || t < samples_.front().stamp || t > samples_.back().stamp + kCarryOn)
    return samples_.end();
  auto it = std::lower_bound(samples_.begin(), samples_.end(), t,
                             [](const Heading& h, Time time) { return h.stamp < time; });
  if (it == samples_.begin()) ++it;
  if (it == samples_.end()) --it;
  return it->stamp - (it - 1)->stamp > kLongestGap ? samples_.end() : it;
}

std::optional<double> ImuTrack::heading_at(Time t) const {
  const auto b = after(t);
  if (b == samples_.end()) return std::nullopt;
  const auto a = b - 1;
  const double share = to_seconds(t - a->stamp) / to_seconds(b->stamp - a->stamp);
  return a->yaw_rad + share * (b->yaw_rad - a->yaw_rad);
}

std::optional<Eigen::Quaterniond> ImuTrack::tilt_at(Time t) const {
  const auto b = after(t);
  if (b == samples_.end()) return std::nullopt;
  const auto a = b - 1;
  const double share = std::clamp(to_seconds(t - a->stamp) / to_seconds(b->stamp - a->stamp), 0.0, 1.0);
  return usual_tilt_.conjugate() * a->tilt.slerp(share, b->tilt);
}

double ImuTrack::tilt_rate(Time t) const {
  const auto a = tilt_at(t - kRateOver / 2), b = tilt_at(t + kRateOver / 2);
  return a && b ? a->angularDistance(*b) / to_seconds(kRateOver) : 0.0;
}

}  // namespace dynslam
