// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "base/angles.h"
#include "base/imu_sample.h"

namespace dynslam {

/// The last seconds of the IMU's heading: spikes smoothed (thesis 4.1.1), made continuous over full turns
/// (thesis, listing 4.1), interpolated at any time in between. One thread.
class ImuTrack {
 public:
  /// Samples that do not advance in time are dropped and counted; a clock that was set back starts the track
  /// anew.
  void add(const ImuSample& sample);

  bool empty() const { return samples_.empty(); }
  /// Until then all spikes are out: the newest sample may be one until the next is there. REQUIRES: !empty().
  Time settled() const { return samples_[samples_.size() < 2 ? 0 : samples_.size() - 2].stamp; }

  /// Heading at a time, continuous from call to call, in the IMU's own frame. Past the newest sample it is
  /// carried on with the last rate, for up to kCarryOn; nothing is said farther out, across a gap longer than
  /// kLongestGap, or before the oldest sample kept.
  std::optional<double> heading_at(Time t) const;

  /// Roll and pitch at a time, as the turn from the robot's axes to level ones of the same heading. An IMU is
  /// seldom mounted quite level: what is usual over half a minute counts as level. Nothing is said where
  /// heading_at says nothing.
  std::optional<Eigen::Quaterniond> tilt_at(Time t) const;
  /// How fast roll and pitch change around a time, rad/s; 0 where nothing is known.
  double tilt_rate(Time t) const;

  std::uint64_t spikes_smoothed() const { return spikes_; }
  std::uint64_t out_of_order() const { return out_of_order_; }

  static constexpr Duration kKept = std::chrono::seconds(4);
  static constexpr Duration kCarryOn = std::chrono::milliseconds(60);
  static constexpr Duration kLongestGap = std::chrono::milliseconds(150);
  static constexpr Duration kRateOver = std::chrono::milliseconds(60);
  /// A single sample that lies this far off both its neighbours' course is a spike: no indoor robot turns so
  /// fast.
  static constexpr double kSpikeRate_radps = 6.0;

 private:
  struct Heading {
    Time stamp;
    double yaw_rad;           ///< continuous
    Eigen::Quaterniond tilt;  ///< level_q_robot as measured
  };
  void smooth_last_but_one();
  void learn_usual_tilt(const Heading& heading);
  /// The sample after a time, which has one before it; end() where nothing can be said of that time.
  std::deque<Heading>::const_iterator after(Time t) const;

  std::deque<Heading> samples_;
  Eigen::Quaterniond usual_tilt_ = Eigen::Quaterniond::Identity();
  double tilt_known_s_ = 0.0;
  std::uint64_t spikes_ = 0;
  std::uint64_t out_of_order_ = 0;
};

}  // namespace dynslam
