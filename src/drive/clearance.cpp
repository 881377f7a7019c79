// SPDX-License-Identifier: MIT
#include "drive/clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "drive/hidden_walls.h"

namespace dynslam {
namespace {

/// Slower than this is not worth to be driven: the robot holds.
constexpr double kLeastSpeed_mps = 0.03;
/// Nobody knows where the robot went in a longer time.
constexpr Duration kLongestGap = std::chrono::milliseconds(500);

}  // namespace

void Clearance::see(const Scan& scan, const RecentMotion& motion) {
  const Time end = end_of(scan);
  const bool knows = end_ && end >= *end_ && end - *end_ <= kLongestGap;
  const Look look{end, scan.mount.robot_T_lidar, Sight(scan, motion.between(scan.stamp, end).yaw),
                  knows ? std::optional(motion.between(*end_, end)) : std::nullopt};
  points_ = obstacle_points(scan, body_, config_.min_range_m, motion);
  glass_.see(points_, look);
  walkers_.see(points_, look);
  near_.add_to(points_, look, body_);
  continue_walls(points_, look, body_, config_.blind_m);
  glass_.add_to(points_, body_);
  walkers_.add_to(points_, body_);
  end_ = end;
}

double Clearance::stopping_distance_m(double speed_mps) const {
  return speed_mps * config_.reaction_s + 0.5 * speed_mps * speed_mps / config_.deceleration_mps2;
}

double Clearance::safe_speed_mps(double distance_m) const {
  const double t = config_.reaction_s, a = config_.deceleration_mps2;
  return a * (std::sqrt(t * t + 2.0 * std::max(0.0, distance_m) / a) - t);
}

double Clearance::distance_to_body_m(double x, double y) const {
  return std::hypot(std::max(0.0, std::abs(x) - body_.half_length_m()),
                    std::max(0.0, std::abs(y) - body_.half_width_m()));
}

/// Of points that can be reached within the horizon; an infinite time when there is none.
Clearance::Contact Clearance::first_contact(const Sweep& sweep, const Pose2& now_T_end,
                                            double horizon_m) const {
  Contact first{std::numeric_limits<double>::infinity(), 0.0};
  const double c = std::cos(now_T_end.yaw), s = std::sin(now_T_end.yaw);
  const double reach = body_.radius_m() + config_.stop_margin_m + config_.side_margin_m + horizon_m;
  for (const ObstaclePoint& p : points_) {
    const double x = now_T_end.x + c * p.x_m - s * p.y_m, y = now_T_end.y + s * p.x_m + c * p.y_m;
    if (x * x + y * y > reach * reach) continue;
    const double time_s = sweep.contact_s(x, y);
    if (time_s < first.time_s) first = {time_s, distance_to_body_m(x, y)};
  }
  return first;
}

double Clearance::nearest_m(Time now, const RecentMotion& motion) const {
  double nearest = std::numeric_limits<double>::infinity();
  if (!end_) return nearest;
  const Pose2 now_T_end = motion.between(*end_, now).inverse();
  const double c = std::cos(now_T_end.yaw), s = std::sin(now_T_end.yaw);
  for (const ObstaclePoint& p : points_) {
    const double x = now_T_end.x + c * p.x_m - s * p.y_m, y = now_T_end.y + s * p.x_m + c * p.y_m;
    if (x < -body_.half_length_m()) continue;
    const double beyond = std::max(std::abs(x) - body_.half_length_m(), std::abs(y) - body_.half_width_m());
    if (beyond < nearest) nearest = std::min(nearest, distance_to_body_m(x, y));
  }
  return nearest;
}

/// Where the scan's points are if the robot drove since, and if it only turned, or not even that.
Clearance::Contact Clearance::first_contact(Time now, const Twist& twist, const RecentMotion& motion,
                                            double side_margin_m) const {
  const Pose2 moved = motion.between(*end_, now).inverse();
  const Pose2 stayed{0.0, 0.0, motion.knows_turns() ? moved.yaw : 0.0};
  const double horizon_m =
      stopping_distance_m(std::max({body_speed_mps(twist), config_.creep_mps, kLeastSpeed_mps}));
  const Sweep sweep(body_, {config_.stop_margin_m, side_margin_m}, twist);
  const Contact first = first_contact(sweep, moved, horizon_m);
  if (moved == stayed) return first;
  const Contact other = first_contact(sweep, stayed, horizon_m);
  return other.time_s < first.time_s ? other : first;
}

double Clearance::free_m(Time now, const Twist& twist, const RecentMotion& motion,
                         double side_margin_m) const {
  if (!end_) return 0.0;
  return first_contact(now, twist, motion, side_margin_m).time_s * body_speed_mps(twist);
}

ClearWay Clearance::way(Time now, const Twist& twist, const RecentMotion& motion) const {
  if (!is_moving(twist)) return {};
  if (!end_) return {0.0, 0.0};
  const double speed = body_speed_mps(twist);
  const Contact nearest = first_contact(now, twist, motion, config_.side_margin_m);
  double allowed = safe_speed_mps(nearest.time_s * speed);
  if (allowed < std::min(speed, config_.creep_mps)) {
    const double creeping_m = free_m(now, twist, motion, config_.creep_margin_m);
    allowed = std::max(allowed, std::min(config_.creep_mps, safe_speed_mps(creeping_m)));
  }
  if (allowed < kLeastSpeed_mps) return {0.0, nearest.distance_m};
  return {std::min(1.0, allowed / speed), nearest.distance_m};
}

}  // namespace dynslam
