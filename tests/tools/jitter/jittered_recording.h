// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "io/recording.h"
#include "tools/jitter/portable_random.h"

namespace dynslam::jitter {

/// What is done to a recording; zero and false leave it as it is.
struct JitterConfig {
  double drop_share = 0.05;      ///< of the scans, each by chance
  double odometry_noise = 0.01;  ///< deviation of the factors on each step's way and turn
  double cut_s = 3.0;         ///< off the beginning, counted from the first scan: a log may run long before
  bool move_odometry = true;  ///< turn and shift the odometry's origin by chance
  bool turn_imu = true;       ///< turn the IMU's heading by a constant chance angle
};

/// A recording as it might have come out on another day: what SLAM makes of it should hardly differ. The
/// seed says all; each kind of jitter draws from a stream of its own, so that switching one off leaves the
/// others as they were.
class JitteredRecording final : public Recording {
 public:
  JitteredRecording(std::unique_ptr<Recording> recording, const JitterConfig& config, std::uint64_t seed);

  std::optional<Record> next() override;
  double progress() const override { return recording_->progress(); }
  const std::optional<std::string>& damage() const override { return recording_->damage(); }
  const Counters& counters() const override { return recording_->counters(); }

 private:
  bool is_cut(const Record& record);
  bool keep(const Scan& scan);
  bool keep(ImuSample& sample) const;
  bool keep(OdometrySample& sample);
  Pose2 with_noise(const Pose2& recorded);

  std::unique_ptr<Recording> recording_;
  JitterConfig config_;
  PortableRandom drops_, noise_;
  Pose2 moved_T_odom_;
  Eigen::Quaterniond turned_q_world_ = Eigen::Quaterniond::Identity();
  std::optional<Time> first_scan_;
  bool begun_ = false;
  std::optional<Pose2> last_recorded_;
  Pose2 last_noisy_;
};

}  // namespace dynslam::jitter
