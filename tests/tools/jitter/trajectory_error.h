// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "io/trajectory.h"

namespace dynslam::jitter {

/// Where the robot was at one time, by the reference and by the estimate, each in its own frame.
struct PosePair {
  Pose2 ref_T_robot;
  Pose2 map_T_robot;
};

/// A pair for each stamp of the reference that the estimate has something to say about: a pose within a
/// millisecond, else between two neighbours at most 3 s apart, else the nearest within 0.1 s. Either may be
/// in any order; of equal stamps the last counts.
std::vector<PosePair> pair_up(const std::vector<StampedPose>& estimate,
                              const std::vector<StampedPose>& reference);

/// ref_T_map: the rigid motion that brings the estimated positions nearest to the reference's, in the mean of
/// squares. Where the robot hardly moved, positions say nothing of the turn and headings decide.
/// REQUIRES: !pairs.empty().
Pose2 alignment(const std::vector<PosePair>& pairs);

/// Absolute trajectory error: RMSE of the positions after alignment, metres. Throws InputError for fewer than
/// two pairs.
double absolute_error_m(const std::vector<StampedPose>& estimate, const std::vector<StampedPose>& reference);

}  // namespace dynslam::jitter
