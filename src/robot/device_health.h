// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "device/device.h"
#include "pipe/latest.h"

namespace dynslam {

/// How a device is doing, as shown to people.
struct DeviceHealth {
  bool present = false;
  std::uint64_t samples = 0;
  std::uint64_t errors = 0;
  Time last_sample;        ///< stamp of the newest
  std::string trouble;     ///< what it said last, empty while it answers
  std::string about = {};  ///< what it is; empty while that is not known
  Counters counters = {};  ///< what it got over
};

/// Keeps the health of a device, and shows it when that is news, else some times a second. By the thread that
/// uses the device.
class HealthKeeper {
 public:
  /// Shows at once that there is a device; null: there is none, and nothing is shown. Both must outlive this.
  HealthKeeper(const Device* device, Latest<DeviceHealth>& shown);

  void answered(Time stamp);
  void failed(const std::string& trouble);

 private:
  void ask_device();

  const Device* device_;
  Latest<DeviceHealth>& shown_;
  DeviceHealth health_;
  Time shown_at_, asked_at_;
};

}  // namespace dynslam
