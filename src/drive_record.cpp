// SPDX-License-Identifier: MIT
#include "drive_record.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr double kFelt_radps = 0.15;  ///< slower turns go unnoticed
constexpr double kMoved_m = 0.05;     ///< less may be the pose's noise

}  // namespace

void DriveRecord::note(Time now, const Ports& ports) {
  const auto status = ports.autopilot.get().value;
  const auto drive = ports.drive.get().value;
  const auto world = ports.world.get().value;
  if (!status || status->phase != AutopilotPhase::kActive || !drive || !world) {
    stands_since_.reset();
    pose_.reset();
    return;
  }
  if (is_moving(drive->applied) || status->route_map.empty()) {
    stands_since_.reset();
  } else {
    if (!stands_since_) stands_since_ = now;
    longest_wait_s_ = std::max(longest_wait_s_, to_seconds(now - *stands_since_));
  }
  const double turn_radps = drive->applied.w_radps;
  if (std::abs(turn_radps) > kFelt_radps) {
    if (turn_radps * turns_radps_ < 0.0) ++reversals_;
    turns_radps_ = turn_radps;
  }
  const Pose2& pose = world->pose.map_T_robot;
  if (!pose_) pose_ = pose;
  const double moved_m = (pose.translation() - pose_->translation()).norm();
  if (moved_m < kMoved_m) return;
  way_m_ += moved_m;
  pose_ = pose;
}

}  // namespace dynslam
