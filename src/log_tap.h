// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <spdlog/common.h>

#include "robot/ports.h"

namespace dynslam {

/// Hands the lines of the program's log to the robot as well, for its recordings and for people, as long as
/// this lives. To be made and let go while no other thread logs.
class LogTap {
 public:
  /// Both must outlive it.
  LogTap(Ports& ports, const Clock& clock);
  ~LogTap();
  LogTap(const LogTap&) = delete;
  LogTap& operator=(const LogTap&) = delete;

 private:
  spdlog::sink_ptr sink_;
};

}  // namespace dynslam
