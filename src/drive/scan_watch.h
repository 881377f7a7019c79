// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "base/scan.h"
#include "drive/finding.h"
#include "drive/safety_config.h"

namespace dynslam {

/// Whether the lidar still sees the world: its newest scan that is any good must not be too old. Not good is
/// one from the future, one older than the one before, one with next to no valid beam or without a single
/// wall, and one that repeats
/// the ranges of the one before to the last bit, as only a frozen lidar does.
class ScanWatch {
 public:
  explicit ScanWatch(const SafetyConfig& config) : timeout_(from_seconds(config.scan_timeout_s)) {}

  /// Takes the newest scan; none, or the same one again, is fine.
  Finding update(Time now, const std::shared_ptr<const Scan>& newest);
  void clock_went_back() { *this = ScanWatch(timeout_); }

  /// The newest good scan; null before there is one.
  const std::shared_ptr<const Scan>& good() const { return good_; }

 private:
  enum class Trouble { kNone, kFuture, kBlind, kFrozen };

  explicit ScanWatch(Duration timeout) : timeout_(timeout) {}
  Trouble take(Time now, const std::shared_ptr<const Scan>& scan);

  Duration timeout_;
  std::shared_ptr<const Scan> newest_, good_;
  Time good_end_;                     ///< when the good scan's last beam was taken
  Trouble trouble_ = Trouble::kNone;  ///< of the newest scan
};

}  // namespace dynslam
