// SPDX-License-Identifier: MIT
#include "drive/sight.h"

#include <algorithm>
#include <cmath>

#include "drive/obstacle_points.h"

namespace dynslam {
namespace {

constexpr std::size_t kNeighbours = 2;  ///< on either side

/// One return amid beams that find nothing is noise.
bool is_alone(const Scan& scan, std::size_t i) {
  const std::size_t n = scan.beams.size();
  for (std::size_t step = 1; step <= kNeighbours && step < n; ++step)
    if (is_return(scan.beams[(i + n - step) % n]) || is_return(scan.beams[(i + step) % n])) return false;
  return true;
}

}  // namespace

Sight::Sight(const Scan& scan, double turned_rad) {
  const double length_s = to_seconds(end_of(scan) - scan.stamp);
  const double side = scan.mount.upside_down ? -1.0 : 1.0;
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    const Beam& beam = scan.beams[i];
    if (!is_return(beam) || !std::isfinite(beam.angle_rad) || is_alone(scan, i)) continue;
    const bool timed = beam.time_s > 0.0F && beam.time_s <= length_s;
    const double left = timed ? 1.0 - beam.time_s / length_s : 1.0;
    double& far = farthest_m_[sector_of(side * beam.angle_rad - left * turned_rad)];
    far = std::max(far, static_cast<double>(beam.range_m));
  }
}

std::size_t Sight::sector_of(double angle_rad) {
  const double turns = angle_rad / kTwoPi;
  const double share = turns - std::floor(turns);
  return static_cast<std::size_t>(share * static_cast<double>(kSectors)) % kSectors;
}

std::size_t Sight::sector_of(const Vector2& from_lidar) {
  return sector_of(std::atan2(from_lidar.y(), from_lidar.x()));
}

double Sight::middle_rad(std::size_t sector) {
  return kTwoPi * (static_cast<double>(sector % kSectors) + 0.5) / static_cast<double>(kSectors);
}

}  // namespace dynslam
