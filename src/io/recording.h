// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "base/counters.h"
#include "base/imu_sample.h"
#include "base/odometry.h"
#include "base/scan.h"

namespace dynslam {

/// One thing a sensor said.
using Record = std::variant<Scan, ImuSample, OdometrySample>;

struct RecordingConfig {
  LidarMount lidar_mount;  ///< where the recording does not say it itself
};

/// What was recorded, in the order of the file, read as a stream: memory does not grow with the file.
/// Values are clean: quaternions are unit length, angles and odometry finite, ranges finite and positive or
/// +inf (no return) or NaN (invalid), stamps representable. What had to be dropped for it is counted. One
/// thread at a time.
class Recording {
 public:
  virtual ~Recording() = default;

  /// The next record; nothing at the end, or where the file stops making sense: then damage() says so.
  virtual std::optional<Record> next() = 0;

  /// Share of the file's bytes that were read, 0 to 1.
  virtual double progress() const = 0;

  /// Set when the file broke off before its end: one line with the file, the place, and how far reading got.
  virtual const std::optional<std::string>& damage() const = 0;

  /// What was skipped and why, by name.
  virtual const Counters& counters() const = 0;
};

/// Opens a CARMEN log (.clf, .log, also gzipped) or an MCAP file; which one is told from the contents, not
/// the name. Throws InputError, with the path in the message, when the file is missing, a directory, empty,
/// unreadable or neither.
std::unique_ptr<Recording> open_recording(const std::string& path, const RecordingConfig& config = {});

}  // namespace dynslam
