// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "base/time.h"

namespace dynslam {

/// As ROS 2 numbers them.
enum class LogLevel : std::uint8_t { kDebug = 10, kInfo = 20, kWarn = 30, kError = 40, kFatal = 50 };

/// A line of the program's log.
struct LogLine {
  Time time;
  LogLevel level = LogLevel::kInfo;
  std::string text;
};

}  // namespace dynslam
