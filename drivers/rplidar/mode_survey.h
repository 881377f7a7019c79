// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "drivers/rplidar/device_talk.h"

namespace dynslam::rplidar {

/// Asks a lidar for its scan modes, question by question.
class ModeSurvey {
 public:
  /// True when all is known; false: not by `until`, to be called again. Throws DeviceError.
  bool ask(DeviceTalk& talk, const DeviceInfo& info, Time until);

  /// Those that can be decoded; at least one.
  const std::vector<ScanMode>& modes() const { return modes_; }
  /// Which one the maker recommends.
  std::optional<std::uint16_t> typical() const { return typical_; }

 private:
  bool ask_legacy(DeviceTalk& talk, Time until);
  bool ask_mode(DeviceTalk& talk, Time until);

  std::vector<ScanMode> modes_;
  std::optional<std::uint16_t> count_, typical_;
  std::uint16_t next_ = 0;     ///< mode to ask about
  std::size_t next_item_ = 0;  ///< what to ask about it
  ScanMode mode_;              ///< as far as it was asked
  bool can_use_ = true;
};

}  // namespace dynslam::rplidar
