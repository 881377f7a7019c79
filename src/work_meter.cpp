// SPDX-License-Identifier: MIT
#include "work_meter.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>

#include "robot/robot.h"

namespace dynslam {
namespace {

double thread_cpu_s() {
  std::timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// All that is not named is a stage of SLAM.
Work work_of(std::string_view stage) {
  if (stage == Robot::kSensing) return Work::kSensing;
  if (stage == Robot::kPlanning) return Work::kPlanning;
  if (stage == Robot::kPiloting) return Work::kPiloting;
  if (stage == Robot::kControlling) return Work::kControlling;
  return stage == "close loops" ? Work::kLoops : Work::kMapping;
}

}  // namespace

double WorkCost::total_ms() const { return std::accumulate(ms.begin(), ms.end(), 0.0); }

double WorkCost::mean_ms() const { return ms.empty() ? 0.0 : total_ms() / static_cast<double>(ms.size()); }

double WorkCost::p99_ms() const {
  if (ms.empty()) return 0.0;
  std::vector<float> sorted = ms;
  const auto beyond = static_cast<std::size_t>(0.01 * static_cast<double>(ms.size()));
  const auto at = sorted.end() - 1 - static_cast<std::ptrdiff_t>(beyond);
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

/// A scan is over when SLAM says so; looking for the next one and taking the IMU in counts for that one.
void WorkMeter::enter(std::string_view stage) {
  const Work work = work_of(stage);
  begin(work);
  if (work != Work::kMapping && work != Work::kSensing) count(work);
  if (!stage.empty()) return;
  count(Work::kMapping);
  count(Work::kSensing);
}

void WorkMeter::rest() {
  pass(std::nullopt);
  for (std::size_t i = 0; i < kWorks; ++i) {
    if (!done_[i]) continue;
    costs_[i].ms.push_back(static_cast<float>(1e3 * open_s_[i]));
    open_s_[i] = 0.0;
    done_[i] = false;
  }
}

void WorkMeter::pass(std::optional<Work> next) {
  const double cpu_s = thread_cpu_s();
  if (now_) open_s_[static_cast<std::size_t>(*now_)] += cpu_s - since_s_;
  now_ = next;
  since_s_ = cpu_s;
}

}  // namespace dynslam
