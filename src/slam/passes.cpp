// SPDX-License-Identifier: MIT
#include "slam/passes.h"

#include <algorithm>
#include <cmath>

namespace dynslam {

std::vector<Ray> clamp_pass(const Scan& scan, const SlamConfig& config) {
  const auto trusted = static_cast<float>(config.trusted_range_m);
  const auto least = static_cast<float>(config.min_range_m);
  const float side = scan.mount.upside_down ? -1.0F : 1.0F;
  std::vector<Ray> rays;
  rays.reserve(scan.beams.size());
  for (const Beam& b : scan.beams) {
    if (!is_return(b) || b.range_m < least) continue;
    rays.push_back({side * b.angle_rad, std::min(b.range_m, trusted), b.time_s, b.range_m <= trusted});
  }
  return rays;
}

Time reference_time(const Scan& scan) {
  if (scan.beams.empty()) return scan.stamp;
  return scan.stamp + from_seconds(0.5 * (scan.beams.front().time_s + scan.beams.back().time_s));
}

double beam_step(const Scan& scan) {
  if (scan.beams.size() < 2) return 0.0;
  return std::abs(scan.beams.back().angle_rad - scan.beams.front().angle_rad) /
         static_cast<double>(scan.beams.size() - 1);
}

CorrectedScan egomotion_pass(const Scan& scan, const std::vector<Ray>& rays, const MotionInScan& motion) {
  CorrectedScan out;
  out.reference = reference_time(scan);
  out.robot_T_lidar = scan.mount.robot_T_lidar;
  out.beam_step_rad = beam_step(scan);
  out.ends_lidar.reserve(rays.size());
  const Pose2 lidar_T_robot = out.robot_T_lidar.inverse();
  // The motion is smooth: a pose for every few beams, straight lines in between, is as good as one for each.
  constexpr std::size_t kStride = 16;
  Pose2 here, next;
  float here_s = 0, next_s = 0;
  const auto lidar_at = [&](float time_s) {
    return lidar_T_robot * motion(scan.stamp + from_seconds(time_s)) * out.robot_T_lidar;
  };
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (i % kStride == 0) {
      here_s = rays[i].time_s;
      next_s = rays[std::min(i + kStride, rays.size() - 1)].time_s;
      here = i == 0 ? lidar_at(here_s) : next;
      next = next_s == here_s ? here : lidar_at(next_s);
    }
    const float share = next_s == here_s ? 0.0F : (rays[i].time_s - here_s) / (next_s - here_s);
    const Pose2 lidar = interpolate(here, next, share);
    const double angle = lidar.yaw + rays[i].angle_rad;
    const double x = lidar.x + rays[i].range_m * std::cos(angle), y = lidar.y + rays[i].range_m * std::sin(angle);
    out.ends_lidar.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(std::atan2(y, x)),
                              static_cast<float>(std::hypot(x, y)), rays[i].hit});
  }
  const auto by_bearing = [](const RayEnd& a, const RayEnd& b) { return a.bearing_rad < b.bearing_rad; };
  std::sort(out.ends_lidar.begin(), out.ends_lidar.end(), by_bearing);
  return out;
}

}  // namespace dynslam
