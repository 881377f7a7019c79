// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "io/recording.h"
#include "io/trajectory.h"
#include "slam/slam_config.h"
#include "tools/jitter/jittered_recording.h"

namespace dynslam::jitter {

struct JitterPlan {
  JitterConfig jitter;
  SlamConfig slam;
  int copies = 20;         ///< besides the recording as it is
  std::uint64_t seed = 1;  ///< of the first copy; each further one has the next
  int jobs = 1;            ///< threads
};

/// What SLAM made of one copy.
struct CopyResult {
  std::optional<std::uint64_t> seed;  ///< none: as recorded
  std::size_t scans = 0;
  double final_m = 0.0;  ///< absolute error of the trajectory as known at the end
  double live_m = 0.0;   ///< and as known at the time
  std::uint64_t closures = 0;
  std::vector<StampedPose> trajectory;  ///< as known at the end
};

/// Opens the same recording anew, in any thread.
using OpenRecording = std::function<std::unique_ptr<Recording>()>;

/// Takes the recording as it is and then its jittered copies through SLAM; returns their results in that
/// order. `tell` hears of each in the same order, in the caller's thread, as soon as may be. Throws
/// InputError for a recording that is damaged, has no usable scan, or nothing to do with the reference.
std::vector<CopyResult> run_copies(const OpenRecording& open, const std::vector<StampedPose>& reference,
                                   const JitterPlan& plan,
                                   const std::function<void(const CopyResult&)>& tell);

}  // namespace dynslam::jitter
