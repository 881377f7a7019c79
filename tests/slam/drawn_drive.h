// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "slam/drawn_world.h"
#include "slam/slam.h"

namespace dynslam {

/// A way of straight legs and turns in place, each begun and ended gently.
class Route {
 public:
  explicit Route(const Pose2& start) : knots_{{0.0, start}} {}

  Route& stand(double seconds) { return arrive(seconds, last()); }
  /// Less than half a turn.
  Route& turn_by(double rad) { return arrive(time_for(std::abs(rad), 0.8, 3.0), last() * Pose2{0, 0, rad}); }
  /// Backwards if negative.
  Route& go(double metres) {
    return arrive(time_for(std::abs(metres), 0.5, 1.0), last() * Pose2{metres, 0, 0});
  }
  Route& go_to(double x, double y) {
    const Vector2 way = last().inverse() * Vector2(x, y);
    const double bearing = std::atan2(way.y(), way.x());
    if (std::abs(bearing) > 1e-6) turn_by(bearing);
    return go(way.norm());
  }

  double end_s() const { return knots_.back().first; }
  Pose2 operator()(Time t) const {
    const double s = seconds_of(t);
    const auto after = std::find_if(knots_.begin(), knots_.end(), [s](const auto& k) { return k.first > s; });
    if (after == knots_.begin()) return knots_.front().second;
    if (after == knots_.end()) return last();
    const auto& [from_s, from] = *(after - 1);
    const double share = (s - from_s) / (after->first - from_s);
    return interpolate(from, after->second, 0.5 - 0.5 * std::cos(kPi * share));
  }

 private:
  const Pose2& last() const { return knots_.back().second; }
  Route& arrive(double seconds, const Pose2& pose) {
    knots_.emplace_back(end_s() + seconds, pose);
    return *this;
  }
  static double time_for(double way, double mean_speed, double most_acceleration) {
    return std::max(way / mean_speed, kPi * std::sqrt(0.5 * way / most_acceleration));
  }

  std::vector<std::pair<double, Pose2>> knots_;
};

/// A map laid over the world it was made of.
struct MapView {
  GridSnapshot map;
  Pose2 map_T_world;

  CellState at(const Vector2& p) const { return map.state(cell_at(map_T_world * p, map.cell_size_m())); }
  CellState at(double x, double y) const { return at(Vector2(x, y)); }

  struct Run {  ///< of occupied cells along a line, metres from its beginning
    double from_m, to_m;
    double middle_m() const { return 0.5 * (from_m + to_m); }
  };
  std::vector<Run> runs(const Vector2& from, const Vector2& to) const {
    constexpr double kStep_m = 0.0002;
    std::vector<Run> found;
    const double length = (to - from).norm();
    bool was = false;
    for (double s = 0; s <= length; s += kStep_m) {
      const bool is = at(from + s / length * (to - from)) == CellState::kOccupied;
      if (is && !was) found.push_back({s, s});
      if (is) found.back().to_m = s;
      was = is;
    }
    return found;
  }
  /// Cells of a state whose middles lie in a rectangle.
  int count(CellState state, const Vector2& low, const Vector2& high) const {
    int n = 0;
    for_each_cell([&](const Vector2& p, CellState s) {
      n += s == state && (p.array() > low.array()).all() && (p.array() < high.array()).all() ? 1 : 0;
    });
    return n;
  }
  /// The share of occupied cells that lie farther than this from all walls.
  double share_off(const DrawnWorld& world, double metres) const {
    int off = 0, all = 0;
    for_each_cell([&](const Vector2& p, CellState s) {
      if (s != CellState::kOccupied) return;
      ++all;
      off += distance_to_walls(world, p) > metres ? 1 : 0;
    });
    return all == 0 ? 1.0 : static_cast<double>(off) / all;
  }
  /// Of the points of a wall, the share that has an occupied cell this near.
  double share_drawn(const DrawnWorld::Wall& wall, double metres) const {
    int drawn = 0, all = 0;
    const double length = (wall.to - wall.from).norm();
    for (double s = 0; s <= length; s += 0.02, ++all)
      drawn += is_occupied_near(wall.from + s / length * (wall.to - wall.from), metres) ? 1 : 0;
    return static_cast<double>(drawn) / all;
  }
  bool is_occupied_near(const Vector2& p, double metres) const {
    for (double dy = -metres; dy <= metres; dy += 0.01) {
      for (double dx = -metres; dx <= metres; dx += 0.01) {
        if (std::hypot(dx, dy) <= metres && at(p + Vector2(dx, dy)) == CellState::kOccupied) return true;
      }
    }
    return false;
  }

 private:
  static double distance_to_walls(const DrawnWorld& world, const Vector2& p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const DrawnWorld::Wall& w : world.walls) {
      const Vector2 along = w.to - w.from;
      const double share = std::clamp((p - w.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (p - w.from - share * along).norm());
    }
    return nearest;
  }
  template <class Visit>
  void for_each_cell(Visit&& visit) const {
    const Pose2 world_T_map = map_T_world.inverse();
    const ChunkBox& box = map.box();
    for (int y = box.min.y * kChunkSide; y < (box.max.y + 1) * kChunkSide; ++y) {
      for (int x = box.min.x * kChunkSide; x < (box.max.x + 1) * kChunkSide; ++x)
        visit(world_T_map * cell_centre({x, y}, map.cell_size_m()), map.state({x, y}));
    }
  }
};

/// A robot that goes its way through a drawn world, ten scans a second, with whatever sensors a test gives
/// it. The world may be drawn anew on the way.
class DrawnDrive {
 public:
  using Way = std::function<Pose2(Time)>;
  /// What arrives of a sample: nothing where it is lost, two where it is doubled.
  template <class Sample>
  using Weather = std::function<std::vector<Sample>(Sample)>;

  template <class Sample>
  static std::vector<Sample> fair(Sample sample) {
    return {std::move(sample)};
  }

  DrawnDrive(DrawnWorld drawn_world, Way way, const SlamConfig& config = {})
      : world(std::move(drawn_world)), world_T_robot(std::move(way)), slam(config) {}

  void until(double t_s) {
    for (; 0.1 * scans_ + 0.05 < t_s; ++scans_) {
      const double now_s = 0.1 * scans_;
      for (int i = 0; i < 10; ++i) feel(time_at_s(now_s + 0.01 * i));
      see(time_at_s(now_s));
      take_results(false);
    }
  }
  void finish() {
    take_results(true);
    slam.finish();
  }

  /// How far off the truth a result is.
  Pose2 error(const ScanResult& r) const {
    return world_T_robot(true_time_.at(r.stamp)).inverse() * world_T_map_ * r.map_T_robot;
  }
  double worst_m(double from_s = 0.0, double to_s = 1e9) const {
    double worst = 0.0;
    for (const ScanResult& r : results) {
      const double t_s = true_time_s(r);
      if (t_s >= from_s && t_s <= to_s) worst = std::max(worst, error(r).translation().norm());
    }
    return worst;
  }
  double true_time_s(const ScanResult& r) const { return seconds_of(true_time_.at(r.stamp)); }

  /// The map as it is now, laid over the world by where the first scan was taken.
  MapView map() {
    const StampedFix first = slam.trajectory().front();
    return {slam.global_map().snapshot(),
            first.map_T_robot * world_T_robot(true_time_.at(first.stamp)).inverse()};
  }

  DrawnWorld world;
  DrawnWorld mirrors;  ///< beams that meet these go on, reflected
  Way world_T_robot;
  std::function<double(Time)> nose_down_rad = [](Time) { return 0.0; };
  DrawnLidar lidar{.beams = 500, .turn_s = 0.08, .noise_m = 0.01};
  double reach_m = std::numeric_limits<double>::infinity();  ///< of the lidar: nothing comes back from beyond
  LidarMount mount;
  Weather<Scan> scan_weather = fair<Scan>;
  Weather<ImuSample> imu;          ///< empty: there is none
  Weather<OdometrySample> wheels;  ///< empty: there are none
  double imu_drift_radps = 0.0;
  std::mt19937 random{7};
  Slam slam;
  std::vector<ScanResult> results;

 private:
  void feel(Time t) {
    if (imu) {
      const double heading = world_T_robot(t).yaw + 1.0 + imu_drift_radps * seconds_of(t);
      const Eigen::Quaterniond q = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                                   Eigen::AngleAxisd(nose_down_rad(t), Eigen::Vector3d::UnitY());
      for (const ImuSample& sample : imu({t, q})) slam.add(sample);
    }
    if (wheels) {
      const Pose2 odom_T_robot = Pose2{5, 5, 1} * world_T_robot({}).inverse() * world_T_robot(t);
      for (const OdometrySample& sample : wheels({t, odom_T_robot})) slam.add(sample);
    }
  }

  void see(Time t) {
    Scan scan{t, {}, mount};
    std::normal_distribution<double> noise(0.0, lidar.noise_m);
    for (int i = 0; i < lidar.beams; ++i) {
      const double angle = -kPi + i * kTwoPi / lidar.beams, time_s = i * lidar.turn_s / lidar.beams;
      const double range = range_of(t + from_seconds(time_s), angle);
      scan.beams.push_back(
          {static_cast<float>(angle), static_cast<float>(range + noise(random)), static_cast<float>(time_s)});
    }
    for (Scan& arrived : scan_weather(std::move(scan))) {
      true_time_[arrived.stamp] = t;
      slam.add(std::move(arrived));
    }
  }

  double range_of(Time t, double angle) const {
    const double pitch = nose_down_rad(t), bearing = mount.robot_T_lidar.yaw + angle;
    const Eigen::Vector3d way(std::cos(pitch) * std::cos(bearing), std::sin(bearing),
                              -std::sin(pitch) * std::cos(bearing));
    const Pose2 robot = world_T_robot(t), eye = robot * mount.robot_T_lidar;
    const double level = distance_by_mirrors(eye.translation(), robot.yaw + std::atan2(way.y(), way.x()));
    double range = level / std::hypot(way.x(), way.y());
    if (way.z() < 0) range = std::min(range, mount.height_m / -way.z());  // the floor
    return range > reach_m ? std::numeric_limits<double>::infinity() : range;
  }

  double distance_by_mirrors(const Vector2& from, double direction) const {
    const double straight = world.distance(from, direction);
    for (const DrawnWorld::Wall& mirror : mirrors.walls) {
      const double to_mirror = DrawnWorld{{mirror}}.distance(from, direction);
      if (to_mirror >= straight) continue;
      const Vector2 way(std::cos(direction), std::sin(direction)), along = mirror.to - mirror.from;
      const double back = 2 * std::atan2(along.y(), along.x()) - direction;
      const Vector2 foot = from + (to_mirror - 1e-6) * way;
      return to_mirror + world.distance(foot, back);
    }
    return straight;
  }

  void take_results(bool at_end) {
    while (const auto r = slam.next(at_end)) {
      if (results.empty()) world_T_map_ = world_T_robot(true_time_.at(r->stamp)) * r->map_T_robot.inverse();
      results.push_back(*r);
    }
  }

  int scans_ = 0;
  std::map<Time, Time> true_time_;  ///< of scans, by stamp
  Pose2 world_T_map_;
};

}  // namespace dynslam
