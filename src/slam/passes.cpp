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

void level_pass(const Scan& scan, const TiltInScan& tilt, const HeightBand& band, std::vector<Ray>& rays) {
  constexpr std::size_t kStride =
      16;  // a tilt serves a few beams: a robot takes longer to tip than they take
  constexpr double kLevel_rad = 0.003;
  const auto mount = static_cast<float>(scan.mount.robot_T_lidar.yaw);
  const auto down = static_cast<float>(std::max(0.0, scan.mount.height_m - band.low_m));
  const auto up = static_cast<float>(std::max(0.0, band.high_m - scan.mount.height_m));
  for (std::size_t begin = 0; begin < rays.size(); begin += kStride) {
    const Eigen::Quaterniond level_q_robot = tilt(scan.stamp + from_seconds(rays[begin].time_s));
    if (level_q_robot.vec().norm() < 0.5 * kLevel_rad) continue;
    const Eigen::Matrix3f turned = level_q_robot.toRotationMatrix().cast<float>();
    for (std::size_t i = begin; i < std::min(begin + kStride, rays.size()); ++i) {
      Ray& ray = rays[i];
      const float bearing = mount + ray.angle_rad;
      const Eigen::Vector3f way = turned * Eigen::Vector3f(std::cos(bearing), std::sin(bearing), 0);
      const float leaves_m = (way.z() < 0 ? down : up) / std::max(std::abs(way.z()), 1e-6F);
      ray.hit = ray.hit && ray.range_m <= leaves_m;
      ray.range_m = std::min(ray.range_m, leaves_m) * std::hypot(way.x(), way.y());
      const Eigen::Vector2d ahead = way.head<2>().cast<double>();
      ray.angle_rad = static_cast<float>(std::atan2(ahead.y(), ahead.x())) - mount;
    }
  }
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

namespace {

/// Sorts ends that come in one or two rising runs, as beams do, without moving them about needlessly.
void sort_by_bearing(std::vector<RayEnd>& ends) {
  const auto by_bearing = [](const RayEnd& a, const RayEnd& b) { return a.bearing_rad < b.bearing_rad; };
  const auto run = std::is_sorted_until(ends.begin(), ends.end(), by_bearing);
  if (std::is_sorted(run, ends.end(), by_bearing)) {
    std::inplace_merge(ends.begin(), run, ends.end(), by_bearing);
  } else {
    std::sort(ends.begin(), ends.end(), by_bearing);
  }
}

}  // namespace

CorrectedScan egomotion_pass(const Scan& scan, const std::vector<Ray>& rays, const MotionInScan& motion) {
  CorrectedScan out;
  out.reference = reference_time(scan);
  out.robot_T_lidar = scan.mount.robot_T_lidar;
  out.beam_step_rad = beam_step(scan);
  out.ends_lidar.resize(rays.size());
  const Pose2 lidar_T_robot = out.robot_T_lidar.inverse();
  const auto lidar_at = [&](float time_s) {
    return lidar_T_robot * motion(scan.stamp + from_seconds(time_s)) * out.robot_T_lidar;
  };
  // The motion is smooth: a pose for every few beams, straight lines in between, is as good as one for each.
  constexpr std::size_t kStride = 16;
  Pose2 here = rays.empty() ? Pose2{} : lidar_at(rays.front().time_s);
  Eigen::ArrayXf angles(static_cast<Eigen::Index>(rays.size()));
  for (std::size_t begin = 0; begin < rays.size(); begin += kStride) {
    const std::size_t end = std::min(begin + kStride, rays.size());
    const float begin_s = rays[begin].time_s, next_s = rays[std::min(end, rays.size() - 1)].time_s;
    const Pose2 next = next_s == begin_s ? here : lidar_at(next_s);
    const auto turned = static_cast<float>(turn(here.yaw, next.yaw));
    const Eigen::Vector2f from = here.translation().cast<float>(),
                          way = (next.translation() - here.translation()).cast<float>();
    for (std::size_t i = begin; i < end; ++i) {
      const float share = next_s == begin_s ? 0.0F : (rays[i].time_s - begin_s) / (next_s - begin_s);
      const Eigen::Vector2f at = from + share * way;
      out.ends_lidar[i] = {at.x(), at.y(), 0, rays[i].range_m, rays[i].hit};
      angles[static_cast<Eigen::Index>(i)] =
          static_cast<float>(here.yaw) + share * turned + rays[i].angle_rad;
    }
    here = next;
  }
  const Eigen::ArrayXf cosines = angles.cos(), sines = angles.sin();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RayEnd& e = out.ends_lidar[i];
    const auto k = static_cast<Eigen::Index>(i);
    // Seen from the reference pose the end is a little nearer or farther and to the side: small angles.
    const float ahead = cosines[k] * e.x_m + sines[k] * e.y_m, aside = cosines[k] * e.y_m - sines[k] * e.x_m;
    const float bearing = angles[k] + aside / (e.range_m + ahead);
    e.x_m += e.range_m * cosines[k];
    e.y_m += e.range_m * sines[k];
    e.range_m = std::sqrt(e.x_m * e.x_m + e.y_m * e.y_m);
    e.bearing_rad = bearing - static_cast<float>(kTwoPi) * std::round(bearing / static_cast<float>(kTwoPi));
  }
  sort_by_bearing(out.ends_lidar);
  return out;
}

void stray_ray_pass(CorrectedScan& scan) {
  constexpr float kNarrow_m = 0.1F;  // no gap narrower than this is believed from one ray
  constexpr float kBeyond_m = 0.15F;
  std::vector<RayEnd>& ends = scan.ends_lidar;
  const auto widest = static_cast<float>(3.0 * scan.beam_step_rad);
  const auto is_stray = [&](std::size_t i) {
    const RayEnd &a = ends[i - 1], &b = ends[i + 1];
    if (b.bearing_rad - a.bearing_rad > widest) return false;
    const float across = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    return ends[i].range_m > std::max(a.range_m, b.range_m) + kBeyond_m && across < kNarrow_m && a.hit &&
           b.hit;
  };
  std::vector<std::size_t> stray;
  for (std::size_t i = 1; i + 1 < ends.size(); ++i) {
    if (is_stray(i)) stray.push_back(i);
  }
  for (auto i = stray.rbegin(); i != stray.rend(); ++i)
    ends.erase(ends.begin() + static_cast<std::ptrdiff_t>(*i));
}

}  // namespace dynslam
