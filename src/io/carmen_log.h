// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "io/byte_source.h"
#include "io/carmen_line.h"
#include "io/line_reader.h"
#include "io/recording.h"
#include "io/skip_counts.h"

namespace dynslam {

/// A log of the CARMEN toolkit, plain or gzipped: PARAM, ODOM, and FLASER or ROBOTLASER1, whichever gives a
/// scan first. Other messages are counted as `carmen.skipped.NAME`. A line that cannot be read costs that
/// line and counts as `carmen.bad_lines`. The odometry that comes with a scan is delivered just before it,
/// with the same stamp. Such a log says one time a scan, so all beams have time 0.
class CarmenLog final : public Recording {
 public:
  CarmenLog(std::unique_ptr<ByteSource> source, const RecordingConfig& config);

  /// Whether the log begins with something a CARMEN log would: call it before next().
  bool looks_right();

  /// Why the text broke off so far; empty if it did not.
  const std::string& fault() const { return lines_.fault(); }

  std::optional<Record> next() override;
  double progress() const override;
  const std::optional<std::string>& damage() const override { return damage_; }
  const Counters& counters() const override { return counters_; }

 private:
  struct Params {
    std::optional<double> fov_rad;
    double max_range_m;
    double mount_x_m = 0.0;
    bool flipped = false;
  };

  bool take(const Line& line);
  bool take_laser(std::string_view name, const std::optional<CarmenLaser>& laser);
  bool take_odometry(const std::optional<CarmenOdometry>& odometry);
  bool take_param(CarmenWords words);
  void deliver(const Pose2& odom_T_robot, double stamp_s);
  LidarMount mount_of(const CarmenLaser& laser);
  std::optional<Scan> make_scan(const CarmenLaser& laser);
  void finish();

  std::unique_ptr<ByteSource> source_;
  LidarMount config_mount_;
  LineReader lines_;
  Params params_;
  std::string laser_name_;  ///< the message that scans come from; empty before the first one
  std::array<std::optional<Record>, 2> ready_;
  std::uint64_t scans_ = 0;
  std::uint64_t first_bad_line_ = 0;
  bool ended_ = false;
  std::optional<std::string> damage_;
  Counters counters_;
  SkipCounts skipped_;
};

}  // namespace dynslam
