// SPDX-License-Identifier: MIT
#include "drive/near_memory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dynslam {
namespace {

/// Nobody knows where the robot went in a longer time.
constexpr Duration kLongestGap = std::chrono::milliseconds(500);
/// What was seen so near outside of the blind zone may have come into it since.
constexpr double kOutside_m = 0.03;
/// So long after it was seen last it is taken to be gone: where nothing comes back from far away either.
constexpr Duration kForgets = std::chrono::seconds(30);
/// Where in it a hidden thing may be, as a share of its radius: one that stood still, and one that came.
constexpr double kStoodAt = 0.98, kCameAt = 0.9;
/// Seen so often, within so much, it stands still.
constexpr int kStands = 3;
constexpr double kSamePlace_m = 0.02;
/// A return from so far behind a thing says that it is gone.
constexpr double kBehind_m = 0.06;

std::size_t sector_of(double angle_rad) {
  const double turns = angle_rad / kTwoPi;
  const double share = turns - std::floor(turns);
  return static_cast<std::size_t>(share * static_cast<double>(NearMemory::kSectors)) % NearMemory::kSectors;
}
std::size_t sector_of(const Vector2& p) { return sector_of(std::atan2(p.y(), p.x())); }

/// How far one sees in each direction, in the lidar's frame seen from above; 0 where nothing comes back.
std::array<float, NearMemory::kSectors> sight(const Scan& scan) {
  std::array<float, NearMemory::kSectors> farthest_m{};
  const double side = scan.mount.upside_down ? -1.0 : 1.0;
  for (const Beam& beam : scan.beams) {
    if (!is_return(beam) || !std::isfinite(beam.angle_rad)) continue;
    float& far = farthest_m[sector_of(side * beam.angle_rad)];
    far = std::max(far, beam.range_m);
  }
  return farthest_m;
}

}  // namespace

void NearMemory::add_to(std::vector<ObstaclePoint>& points, const Scan& scan, const BodyConfig& body,
                        const RecentMotion& motion) {
  const Time end = end_of(scan);
  const bool knows = end_ && end >= *end_ && end - *end_ <= kLongestGap;
  const Pose2 now_T_before = knows ? motion.between(*end_, end).inverse() : Pose2{};
  const Pose2& robot_T_lidar = scan.mount.robot_T_lidar;
  const Pose2 lidar_T_robot = robot_T_lidar.inverse();
  const Near before = std::exchange(near_, {});
  end_ = end;

  for (const ObstaclePoint& p : points) {
    const Vector2 from_lidar = lidar_T_robot * Vector2(p.x_m, p.y_m);
    if (from_lidar.norm() < blind_m_ + kOutside_m) near_[sector_of(from_lidar)] = {{p.x_m, p.y_m}, end, 1};
  }
  if (!knows) return;
  const auto farthest_m = sight(scan);
  const auto is_gone = [&](const Vector2& from_lidar) {
    const std::size_t sector = sector_of(from_lidar);
    // Where it can be seen, any return tells of it; nearer, others of its sector may be seen and it is not.
    if (from_lidar.norm() >= blind_m_ && farthest_m[sector] > 0.0F) return true;
    const auto sees_behind = [&](std::size_t other) {
      return farthest_m[other % kSectors] > from_lidar.norm() + kBehind_m;
    };
    // On one side alone that is the edge of a thing.
    return sees_behind(sector) || (sees_behind(sector + kSectors - 1) && sees_behind(sector + 1));
  };
  for (const auto& was : before) {
    if (!was || end - was->seen > kForgets) continue;
    const Vector2 at = now_T_before * was->at;
    const Vector2 from_lidar = lidar_T_robot * at;
    auto& place = near_[sector_of(from_lidar)];
    if (place && place->seen == end && (place->at - at).norm() < kSamePlace_m) place->times = was->times + 1;
    if (place || from_lidar.norm() > blind_m_ + kOutside_m || is_gone(from_lidar)) continue;
    place = {at, was->seen, was->times};
    const double share = was->times >= kStands ? kStoodAt : kCameAt;
    const double nearer = std::min(1.0, share * blind_m_ / from_lidar.norm());
    const Vector2 p = robot_T_lidar * (nearer * from_lidar);
    const bool own_body = std::abs(p.x()) <= body.half_length_m() && std::abs(p.y()) <= body.half_width_m();
    if (!own_body) points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y())});
  }
}

}  // namespace dynslam
