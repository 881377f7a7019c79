// SPDX-License-Identifier: MIT
#include "drivers/bno055/motion_check.h"

namespace dynslam::bno055 {
namespace {

/// From rest to spinning in a twentieth of a second, and knocks besides.
constexpr double kMostAcceleration_radps2 = 200.0;
constexpr double kKnock_radps = 2.0;
constexpr double kKnock_rad = 0.05;
/// After this, anything may have happened.
constexpr double kUnseen_s = 0.3;

}  // namespace

Nonsense MotionCheck::check(Time stamp, const Motion& motion) {
  if (last_) {
    const double dt = to_seconds(stamp - last_->stamp);
    const double change_radps = kMostAcceleration_radps2 * dt + kKnock_radps;
    const double turn_rad = (last_->motion.rate_radps.norm() + change_radps) * dt + kKnock_rad;
    const Eigen::Vector3d rate_change = motion.rate_radps - last_->motion.rate_radps;
    if (dt < kUnseen_s && rate_change.norm() > change_radps) return Nonsense::kRate;
    if (dt < kUnseen_s && motion.world_q_robot.angularDistance(last_->motion.world_q_robot) > turn_rad)
      return Nonsense::kJump;
  }
  last_ = {stamp, motion};
  return Nonsense::kNone;
}

}  // namespace dynslam::bno055
