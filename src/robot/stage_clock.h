// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "slam/stage_watch.h"

namespace dynslam {

/// Wall and CPU time since it was made, of the whole process.
class WorkTimer {
 public:
  WorkTimer();
  double wall_s() const;
  double cpu_s() const;

 private:
  std::chrono::steady_clock::time_point begun_;
  double cpu_before_s_;
};

/// Measures the stages of each scan, and each scan as the sum of its stages. One thread.
class StageClock : public StageWatch {
 public:
  void enter(std::string_view stage) override;

  std::vector<float> take_scan_ms() { return std::move(scan_ms_); }
  std::map<std::string, double> mean_ms(std::size_t scans) const;

 private:
  std::string_view stage_;
  std::chrono::steady_clock::time_point since_, begun_;
  std::map<std::string_view, double> total_s_;
  std::vector<float> scan_ms_;
};

}  // namespace dynslam
