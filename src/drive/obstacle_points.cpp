// SPDX-License-Identifier: MIT
#include "drive/obstacle_points.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dynslam {
namespace {

constexpr float kLongestScan_s = 1.0F;
constexpr std::size_t kBins = 16;  ///< of a scan's time; within one the robot stands still
/// Neighbours lie this near to each other, or this share of their range.
constexpr float kNear_m = 0.06F;
constexpr float kNearShare = 0.06F;
constexpr std::size_t kNeighbours = 2;  ///< that are looked at on either side: one may have failed

/// Things nearer than this are seen calmly: by the mean of the beams within so much on either side.
constexpr float kCalm_m = 0.6F;
constexpr float kBeside_m = 0.006F;
constexpr float kMostBeside = 8.0F;
constexpr float kSameThing_m = 0.04F;

float time_of(const Beam& beam) {
  return beam.time_s > 0.0F && beam.time_s <= kLongestScan_s ? beam.time_s : 0.0F;
}

float longest_s(const Scan& scan) {
  float longest = 0.0F;
  for (const Beam& beam : scan.beams) longest = std::max(longest, time_of(beam));
  return longest;
}

/// From the lidar's frame at a beam's time to the robot's at the scan's end.
struct Carry {
  float cos, sin, x, y;
};

Carry carry_of(const Pose2& to_T_from) {
  return {static_cast<float>(std::cos(to_T_from.yaw)), static_cast<float>(std::sin(to_T_from.yaw)),
          static_cast<float>(to_T_from.x), static_cast<float>(to_T_from.y)};
}

ObstaclePoint operator*(const Carry& c, const ObstaclePoint& p) {
  return {c.x + c.cos * p.x_m - c.sin * p.y_m, c.y + c.sin * p.x_m + c.cos * p.y_m};
}

std::array<Carry, kBins> carries(const Scan& scan, const RecentMotion& motion, float length_s) {
  std::array<Carry, kBins> all;
  const Time end = scan.stamp + from_seconds(length_s);
  for (std::size_t i = 0; i < kBins; ++i) {
    const double middle_s = length_s * (static_cast<double>(i) + 0.5) / kBins;
    const Pose2 then_T_end = motion.between(scan.stamp + from_seconds(middle_s), end);
    all[i] = carry_of(then_T_end.inverse());
  }
  return all;
}

/// A return in the robot's frame at its own time; outside the body, or `valid` is false.
struct SeenPoint {
  ObstaclePoint p;
  float range_m = 0.0F;
  bool valid = false;
};

/// The range of a beam, of near things as their neighbouring beams have it too. Of many beams the shortest is
/// off by more than twice the noise of one, which is as much as the room in which a robot has to turn.
float calm_range_m(const Scan& scan, std::size_t i) {
  const std::size_t n = scan.beams.size();
  const float range = scan.beams[i].range_m;
  if (range >= kCalm_m) return range;
  const float spacing_m = range * static_cast<float>(kTwoPi) / static_cast<float>(n);
  const float fit = std::min(kBeside_m / spacing_m, kMostBeside);  // all, at a range of zero
  const std::size_t beside = std::min(static_cast<std::size_t>(fit), n / 2);
  float sum = range;
  int count = 1;
  for (std::size_t step = 1; step <= beside; ++step) {
    for (const std::size_t at : {(i + n - step) % n, (i + step) % n}) {
      const Beam& other = scan.beams[at];
      if (!is_return(other) || std::abs(other.range_m - range) > kSameThing_m) continue;
      sum += other.range_m;
      ++count;
    }
  }
  return sum / static_cast<float>(count);
}

std::vector<SeenPoint> seen_points(const Scan& scan, const BodyConfig& body, double min_range_m) {
  const Carry mount = carry_of(scan.mount.robot_T_lidar);
  const float side = scan.mount.upside_down ? -1.0F : 1.0F;
  const auto half_length = static_cast<float>(body.half_length_m());
  const auto half_width = static_cast<float>(body.half_width_m());
  std::vector<SeenPoint> seen(scan.beams.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Beam& beam = scan.beams[i];
    if (!is_return(beam) || !std::isfinite(beam.angle_rad) || beam.range_m < min_range_m) continue;
    const float range_m = calm_range_m(scan, i);
    const ObstaclePoint p =
        mount * ObstaclePoint{range_m * std::cos(beam.angle_rad), side * range_m * std::sin(beam.angle_rad)};
    const bool own_body = std::abs(p.x_m) <= half_length && std::abs(p.y_m) <= half_width;
    seen[i] = {p, beam.range_m, !own_body};
  }
  return seen;
}

bool are_neighbours(const SeenPoint& a, const SeenPoint& b) {
  const float dx = a.p.x_m - b.p.x_m, dy = a.p.y_m - b.p.y_m;
  const float near = std::max(kNear_m, kNearShare * std::min(a.range_m, b.range_m));
  return a.valid && b.valid && dx * dx + dy * dy <= near * near;
}

bool is_lone(const std::vector<SeenPoint>& seen, std::size_t i) {
  for (std::size_t step = 1; step <= kNeighbours && step < seen.size(); ++step) {
    const std::size_t before = (i + seen.size() - step) % seen.size(), after = (i + step) % seen.size();
    if (are_neighbours(seen[i], seen[before]) || are_neighbours(seen[i], seen[after])) return false;
  }
  return true;
}

}  // namespace

Time end_of(const Scan& scan) { return scan.stamp + from_seconds(longest_s(scan)); }

std::vector<ObstaclePoint> obstacle_points(const Scan& scan, const BodyConfig& body, double min_range_m,
                                           const RecentMotion& motion) {
  const float length_s = longest_s(scan);
  const auto carried = carries(scan, motion, length_s);
  const std::vector<SeenPoint> seen = seen_points(scan, body, min_range_m);
  std::vector<ObstaclePoint> points;
  points.reserve(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i].valid || is_lone(seen, i)) continue;
    const float share = length_s > 0.0F ? time_of(scan.beams[i]) / length_s : 1.0F;
    const auto bin = std::min(kBins - 1, static_cast<std::size_t>(share * static_cast<float>(kBins)));
    points.push_back(carried[bin] * seen[i].p);
  }
  return points;
}

}  // namespace dynslam
