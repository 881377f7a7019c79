// SPDX-License-Identifier: MIT
#include "sim/lidar_model.h"

#include <algorithm>
#include <cmath>

#include "sim/robot_shape.h"

namespace dynslam {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
constexpr double kLost = 0.002;    // beams lost for no reason
constexpr double kStray = 0.0004;  // and such that read too short
constexpr double kGrazing = 0.10;  // below this cosine of incidence beams get lost
constexpr double kEdge_m = 0.25;   // a step in range that a beam's spot can straddle
constexpr double kMixed = 0.25;    // share of beams at such an edge that do
constexpr double kDarkRange_m = 10.0;

// Steps that fit into the numbers of a sensor_msgs/LaserScan: a recording says exactly what was measured.
constexpr auto kFirst_rad = static_cast<float>(-kPi),
               kStep_rad = static_cast<float>(kTwoPi / LidarModel::kBeams);
constexpr auto kStep_s = static_cast<float>(to_seconds(LidarModel::kTurn) / LidarModel::kBeams);

}  // namespace

LidarModel::LidarModel(Time begin, std::uint64_t seed) : random_(seed, 2) { begin_turn(begin); }

void LidarModel::begin_turn(Time stamp) {
  scan_ = {};
  scan_.stamp = stamp;
  scan_.mount.height_m = kLidarHeight_m;
  scan_.beams.reserve(kBeams);
}

double LidarModel::measured_m(const SpaceRay& ray, const RayCaster& caster) {
  const auto hit = caster.cast(ray);
  const double true_m = hit ? hit->distance_m * std::hypot(1.0, ray.slope) : kNothing;
  const double before_m = std::exchange(previous_m_, true_m);
  const double luck = random_.uniform();
  const double noise = random_.normal();
  if (!hit || luck < kLost) return kNothing;
  double range_m = true_m;
  const double dark = hit->surface != nullptr ? hit->surface->dark : 0.0;
  if (random_.uniform() < dark || (dark > 0 && range_m > kDarkRange_m)) return kNothing;
  // On the floor a beam as flat as this one gets lost as it does on a grazed wall.
  const double cosine = hit->surface != nullptr ? hit->cosine : std::min(1.0, 2.0 * std::abs(ray.slope));
  if (cosine < kGrazing && random_.uniform() > cosine / kGrazing) return kNothing;
  if (luck > 1.0 - kStray) range_m *= random_.uniform(0.3, 0.9);
  if (std::abs(before_m - true_m) > kEdge_m && std::isfinite(before_m) && random_.uniform() < kMixed) {
    range_m += random_.uniform() * (before_m - true_m);
  }
  range_m += noise * (0.01 + 0.005 * range_m);
  if (range_m < kMinRange_m || range_m > kMaxRange_m) return kNothing;
  return range_m;
}

double LidarModel::range_m(const BodyPose& pose, double angle_rad, const RayCaster& caster) {
  const Eigen::Quaterniond world_q_robot = pose.world_q_robot();
  const Vector2 along = unit(angle_rad);
  const Eigen::Vector3d ahead = world_q_robot * Eigen::Vector3d(along.x(), along.y(), 0.0);
  const Eigen::Vector3d mast = world_q_robot * Eigen::Vector3d(0.0, 0.0, kLidarHeight_m);
  const double level = ahead.head<2>().norm();
  SpaceRay ray;
  ray.from = pose.world_T_robot.translation() + mast.head<2>();
  ray.height_m = pose.lift_m + mast.z();
  ray.direction = ahead.head<2>() / level;
  ray.slope = std::abs(ahead.z()) < 1e-9 ? 0.0 : ahead.z() / level;
  ray.max_m = kMaxRange_m + 1.0;
  ray.glass_cosine = random_.uniform(0.97, 1.0);
  return measured_m(ray, caster);
}

void LidarModel::step(Duration length, const BodyPose& at_begin, const BodyPose& at_end,
                      const RayCaster& caster, Outbox<Scan>& out) {
  const double beam_s = to_seconds(kTurn) / kBeams;
  const int beams = static_cast<int>(std::lround(to_seconds(length) / beam_s));
  for (int k = 0; k < beams; ++k) {
    const auto i = static_cast<int>(scan_.beams.size());
    const BodyPose pose = interpolate(at_begin, at_end, static_cast<double>(k) / beams);
    const double angle = double{kFirst_rad} + i * double{kStep_rad};
    scan_.beams.push_back({static_cast<float>(angle), static_cast<float>(range_m(pose, angle, caster)),
                           static_cast<float>(i * double{kStep_s})});
  }
  if (scan_.beams.size() < kBeams) return;
  const Time next = scan_.stamp + kTurn;
  out.put(next_due(), std::move(scan_));
  begin_turn(next);
}

}  // namespace dynslam
