// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "slam/stage_watch.h"

namespace dynslam {

/// What a robot's computer is kept busy with.
enum class Work : std::size_t {
  kSensing,      ///< taking samples in and handing them on, without the drivers
  kMapping,      ///< from a scan to its pose and the map
  kLoops,        ///< closing loops with a finished local map
  kPlanning,     ///< where to, and by which way
  kPiloting,     ///< commands along the way
  kControlling,  ///< safety, and the motors
  kServing,      ///< what one client is told of state and map
  kPicturing,    ///< a picture of the camera as JPEG
};
inline constexpr std::size_t kWorks = 8;

/// CPU time that one kind of work took.
struct WorkCost {
  std::vector<float> ms;  ///< of each time

  double total_ms() const;
  double mean_ms() const;
  /// The least time that no more than one of a hundred goes beyond; 0 where there is none.
  double p99_ms() const;
};

using WorkCosts = std::array<WorkCost, kWorks>;

/// Sorts the CPU time of the thread by what it was used for. One thread.
class WorkMeter : public StageWatch {
 public:
  /// Of Robot and Slam.
  void enter(std::string_view stage) override;
  void begin(Work work) { pass(work); }
  /// What was done of it since it was counted last was once.
  void count(Work work) { done_[static_cast<std::size_t>(work)] = true; }
  /// What comes is nobody's work, until something begins again.
  void rest();

  const WorkCosts& costs() const { return costs_; }

 private:
  void pass(std::optional<Work> next);

  WorkCosts costs_;
  std::array<double, kWorks> open_s_{};  ///< not yet counted as a time of its own
  std::array<bool, kWorks> done_{};
  std::optional<Work> now_;
  double since_s_ = 0.0;
};

}  // namespace dynslam
