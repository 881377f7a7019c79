// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/open_recording.h"

namespace dynslam::test {

/// All that a recording had to say.
struct Contents {
  std::vector<Record> records;
  std::vector<Scan> scans;
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  std::optional<std::string> damage;
  Counters counters;
};

inline Contents read_all(Recording& recording) {
  Contents contents;
  while (std::optional<Record> record = recording.next()) {
    if (const auto* scan = std::get_if<Scan>(&*record)) contents.scans.push_back(*scan);
    if (const auto* sample = std::get_if<ImuSample>(&*record)) contents.imu.push_back(*sample);
    if (const auto* sample = std::get_if<OdometrySample>(&*record)) contents.odometry.push_back(*sample);
    contents.records.push_back(std::move(*record));
  }
  contents.damage = recording.damage();
  contents.counters = recording.counters();
  return contents;
}

/// The bytes as a file named `memory`.
inline Contents read_all(std::string bytes, const RecordingConfig& config = {}) {
  return read_all(*open_recording(std::make_unique<MemorySource>(std::move(bytes)), config));
}

/// Whether all that a Recording promises of its values holds.
inline bool is_clean(const Record& record) {
  if (const auto* imu = std::get_if<ImuSample>(&record))
    return std::abs(imu->world_q_robot.norm() - 1.0) < 1e-9;
  if (const auto* odometry = std::get_if<OdometrySample>(&record)) return is_finite(odometry->odom_T_robot);
  const Scan& scan = std::get<Scan>(record);
  if (!is_finite(scan.mount.robot_T_lidar)) return false;
  for (const Beam& beam : scan.beams) {
    const bool good_range = beam.range_m > 0.0F || std::isnan(beam.range_m);
    if (!good_range || !std::isfinite(beam.angle_rad) || !std::isfinite(beam.time_s)) return false;
  }
  return true;
}

}  // namespace dynslam::test
