// SPDX-License-Identifier: MIT
#include "drive/near_memory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dynslam {
namespace {

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

}  // namespace

void NearMemory::add_to(std::vector<ObstaclePoint>& points, const Look& look, const BodyConfig& body) {
  const Sight& sight = look.sight;
  const Time end = look.end;
  const Pose2& robot_T_lidar = look.robot_T_lidar;
  const Pose2 lidar_T_robot = robot_T_lidar.inverse();
  const Near before = std::exchange(near_, {});
  for (const ObstaclePoint& p : points) {
    const Vector2 from_lidar = lidar_T_robot * Vector2(p.x_m, p.y_m);
    if (from_lidar.norm() < blind_m_ + kOutside_m)
      near_[Sight::sector_of(from_lidar)] = {{p.x_m, p.y_m}, end, 1};
  }
  if (!look.before_T_now) return;
  const Pose2 now_T_before = look.before_T_now->inverse();
  const auto is_gone = [&](const Vector2& from_lidar) {
    const std::size_t sector = Sight::sector_of(from_lidar);
    // Where it can be seen, any return tells of it; nearer, others of its sector may be seen and it is not.
    if (from_lidar.norm() >= blind_m_ && sight.farthest_m(sector) > 0.0) return true;
    const auto sees_behind = [&](std::size_t other) {
      return sight.farthest_m(other) > from_lidar.norm() + kBehind_m;
    };
    // On one side alone that is the edge of a thing.
    return sees_behind(sector) || (sees_behind(sector + Sight::kSectors - 1) && sees_behind(sector + 1));
  };
  for (const auto& was : before) {
    if (!was || end - was->seen > kForgets) continue;
    const Vector2 at = now_T_before * was->at;
    const Vector2 from_lidar = lidar_T_robot * at;
    auto& place = near_[Sight::sector_of(from_lidar)];
    if (place && place->seen == end && (place->at - at).norm() < kSamePlace_m) place->times = was->times + 1;
    if (place || from_lidar.norm() > blind_m_ + kOutside_m || is_gone(from_lidar)) continue;
    place = {at, was->seen, was->times};
    const double share = was->times >= kStands ? kStoodAt : kCameAt;
    const double nearer = std::min(1.0, share * blind_m_ / from_lidar.norm());
    const Vector2 p = robot_T_lidar * (nearer * from_lidar);
    if (!body.contains(p)) points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y())});
  }
}

}  // namespace dynslam
