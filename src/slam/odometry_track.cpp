// SPDX-License-Identifier: MIT
#include "slam/odometry_track.h"

#include <algorithm>

#include "slam/clock_jump.h"

namespace dynslam {

void OdometryTrack::add(const OdometrySample& sample) {
  if (!samples_.empty() && is_clock_jump(samples_.back().stamp, sample.stamp)) samples_.clear();
  if (!samples_.empty() && sample.stamp < samples_.back().stamp) {
    ++out_of_order_;
    return;
  }
  if (!samples_.empty() && sample.stamp == samples_.back().stamp) samples_.pop_back();
  samples_.push_back(sample);
  // The last two stay however old they are: a log with a scan a minute still has a way to go from.
  while (samples_.size() > 2 && samples_[1].stamp + kKept < sample.stamp) samples_.pop_front();
}

std::optional<Pose2> OdometryTrack::pose_at(Time t) const {
  if (samples_.empty() || t < samples_.front().stamp || t > samples_.back().stamp + kCarryOn)
    return std::nullopt;
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), t,
                                      [](const OdometrySample& s, Time time) { return s.stamp < time; });
  if (after == samples_.end()) return samples_.back().odom_T_robot;
  if (after->stamp == t) return after->odom_T_robot;
  const OdometrySample& a = *(after - 1);
  const double share = to_seconds(t - a.stamp) / to_seconds(after->stamp - a.stamp);
  return interpolate(a.odom_T_robot, after->odom_T_robot, share);
}

}  // namespace dynslam
