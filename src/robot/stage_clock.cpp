// SPDX-License-Identifier: MIT
#include "robot/stage_clock.h"

#include <ctime>

namespace dynslam {
namespace {

using SteadyClock = std::chrono::steady_clock;

double seconds_between(SteadyClock::time_point a, SteadyClock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

double cpu_seconds() {
  std::timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

WorkTimer::WorkTimer() : begun_(SteadyClock::now()), cpu_before_s_(cpu_seconds()) {}
double WorkTimer::wall_s() const { return seconds_between(begun_, SteadyClock::now()); }
double WorkTimer::cpu_s() const { return cpu_seconds() - cpu_before_s_; }

void StageClock::enter(std::string_view stage) {
  const SteadyClock::time_point now = SteadyClock::now();
  if (!stage_.empty()) total_s_[stage_] += seconds_between(since_, now);
  if (stage_.empty()) begun_ = now;
  if (stage.empty()) scan_ms_.push_back(static_cast<float>(1e3 * seconds_between(begun_, now)));
  stage_ = stage;
  since_ = now;
}

std::map<std::string, double> StageClock::mean_ms(std::size_t scans) const {
  std::map<std::string, double> mean;
  for (const auto& [stage, s] : total_s_) mean[std::string(stage)] = 1e3 * s / static_cast<double>(scans);
  return mean;
}

}  // namespace dynslam
