// SPDX-License-Identifier: MIT
#include "tools/jitter/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"

namespace dynslam::jitter {
namespace {

constexpr Duration kSame = std::chrono::milliseconds(1);
constexpr Duration kLongestGap = std::chrono::seconds(3);
constexpr Duration kFarthest = std::chrono::milliseconds(100);
constexpr double kHardlyMoved_m = 0.05;

std::vector<StampedPose> in_order(std::vector<StampedPose> trajectory) {
  std::reverse(trajectory.begin(), trajectory.end());  // so that the last of equals comes first and stays
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  const auto is_same = [](const StampedPose& a, const StampedPose& b) { return a.stamp == b.stamp; };
  trajectory.erase(std::unique(trajectory.begin(), trajectory.end(), is_same), trajectory.end());
  return trajectory;
}

/// REQUIRES: a trajectory in order, not empty.
std::optional<Pose2> pose_at(const std::vector<StampedPose>& trajectory, Time t) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), t,
                                      [](const StampedPose& p, Time at) { return p.stamp < at; });
  const StampedPose& later = after == trajectory.end() ? trajectory.back() : *after;
  const StampedPose& earlier = after == trajectory.begin() ? later : *std::prev(after);
  const Duration to_later = std::chrono::abs(later.stamp - t),
                 to_earlier = std::chrono::abs(t - earlier.stamp);
  const StampedPose& nearest = to_earlier <= to_later ? earlier : later;
  const Duration off = std::min(to_earlier, to_later);
  if (off <= kSame) return nearest.map_T_robot;
  const Duration gap = later.stamp - earlier.stamp;
  const bool is_between = earlier.stamp < t && t < later.stamp;
  if (is_between && gap <= kLongestGap)
    return interpolate(earlier.map_T_robot, later.map_T_robot, to_seconds(to_earlier) / to_seconds(gap));
  if (off <= kFarthest) return nearest.map_T_robot;
  return std::nullopt;
}

/// Both trajectories' means and what their offsets from these say of the turn between the frames.
struct Moments {
  Vector2 mean_ref = Vector2::Zero(), mean_map = Vector2::Zero();
  double along = 0.0, across = 0.0;  ///< sums of dot and cross products, map times ref
  double spread_ref = 0.0, spread_map = 0.0;
};

Moments moments_of(const std::vector<PosePair>& pairs) {
  const auto n = static_cast<double>(pairs.size());
  Moments m;
  for (const PosePair& p : pairs) {
    m.mean_ref += p.ref_T_robot.translation() / n;
    m.mean_map += p.map_T_robot.translation() / n;
  }
  for (const PosePair& p : pairs) {
    const Vector2 ref = p.ref_T_robot.translation() - m.mean_ref;
    const Vector2 map = p.map_T_robot.translation() - m.mean_map;
    m.along += map.dot(ref);
    m.across += map.x() * ref.y() - map.y() * ref.x();
    m.spread_ref += ref.squaredNorm() / n;
    m.spread_map += map.squaredNorm() / n;
  }
  return m;
}

double mean_turn(const std::vector<PosePair>& pairs) {
  double c = 0.0, s = 0.0;
  for (const PosePair& p : pairs) {
    c += std::cos(p.ref_T_robot.yaw - p.map_T_robot.yaw);
    s += std::sin(p.ref_T_robot.yaw - p.map_T_robot.yaw);
  }
  return std::atan2(s, c);
}

}  // namespace

std::vector<PosePair> pair_up(const std::vector<StampedPose>& estimate,
                              const std::vector<StampedPose>& reference) {
  std::vector<PosePair> pairs;
  if (estimate.empty()) return pairs;
  const std::vector<StampedPose> ordered = in_order(estimate);
  for (const StampedPose& ref : in_order(reference)) {
    if (const auto pose = pose_at(ordered, ref.stamp)) pairs.push_back({ref.map_T_robot, *pose});
  }
  return pairs;
}

Pose2 alignment(const std::vector<PosePair>& pairs) {
  const Moments m = moments_of(pairs);
  const bool moved = std::min(m.spread_ref, m.spread_map) >= kHardlyMoved_m * kHardlyMoved_m;
  const Pose2 turned{0.0, 0.0, moved ? std::atan2(m.across, m.along) : mean_turn(pairs)};
  const Vector2 shift = m.mean_ref - turned * m.mean_map;
  return {shift.x(), shift.y(), turned.yaw};
}

double absolute_error_m(const std::vector<StampedPose>& estimate, const std::vector<StampedPose>& reference) {
  const std::vector<PosePair> pairs = pair_up(estimate, reference);
  if (pairs.size() < 2)
    throw InputError("the trajectory and its reference share fewer than two times: are they of one clock?");
  const Pose2 ref_T_map = alignment(pairs);
  double squares = 0.0;
  for (const PosePair& p : pairs)
    squares += (ref_T_map * p.map_T_robot.translation() - p.ref_T_robot.translation()).squaredNorm();
  return std::sqrt(squares / static_cast<double>(pairs.size()));
}

}  // namespace dynslam::jitter
