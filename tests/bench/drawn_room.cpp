// SPDX-License-Identifier: MIT
#include "bench/drawn_room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace dynslam::bench {
namespace {

constexpr int kBeams = 1200;
constexpr int kScans = 400;
constexpr double kScanPeriod_s = 0.1;

struct Wall {
  Vector2 from, to;
};

void add_box(std::vector<Wall>& walls, double x, double y, double width, double depth) {
  const double w = 0.5 * width, d = 0.5 * depth;
  const Vector2 corners[] = {{x - w, y - d}, {x + w, y - d}, {x + w, y + d}, {x - w, y + d}};
  for (int i = 0; i < 4; ++i) walls.push_back({corners[i], corners[(i + 1) % 4]});
}

std::vector<Wall> furnished_room() {
  std::vector<Wall> walls;
  add_box(walls, 0, 0, 12, 9);
  add_box(walls, 0.2, 0.1, 2.8, 1.4);  // a table with closed sides, in the middle
  for (const double side : {-1.0, 1.0}) {
    add_box(walls, side * 5.2, 3.9, 1.4, 0.9);
    add_box(walls, side * 5.4, -3.0, 0.8, 2.2);
    add_box(walls, side * 1.9, side * 3.7, 0.2, 0.2);
    add_box(walls, side * 2.6, -side * 4.1, 0.45, 0.45);
    add_box(walls, side * 4.8, side * 0.6, 0.07, 0.07);
  }
  return walls;
}

/// How far the nearest wall is from a point, in a direction of unit length.
double range_to(const std::vector<Wall>& walls, const Vector2& from, const Vector2& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& w : walls) {
    const Vector2 along = w.to - w.from, to_wall = w.from - from;
    const double turn = direction.x() * along.y() - direction.y() * along.x();
    if (turn == 0) continue;
    const double range = (to_wall.x() * along.y() - to_wall.y() * along.x()) / turn;
    const double share = (to_wall.x() * direction.y() - to_wall.y() * direction.x()) / turn;
    if (range > 0 && share >= 0 && share <= 1) nearest = std::min(nearest, range);
  }
  return nearest;
}

/// Once around the table, looking ahead.
Pose2 pose_on_path(int scan) {
  // Begins off the axes: walls that lie along the rows of the map would make the work too regular.
  const double phase = 0.3 + kTwoPi * scan / kScans;
  return {3.6 * std::cos(phase), 2.4 * std::sin(phase),
          std::atan2(2.4 * std::cos(phase), -3.6 * std::sin(phase))};
}

Scan scan_from(const std::vector<Wall>& walls, const Pose2& room_T_robot, Time stamp, std::mt19937& random) {
  std::normal_distribution<double> unit;
  Scan scan;
  scan.stamp = stamp;
  scan.beams.reserve(kBeams);
  for (int i = 0; i < kBeams; ++i) {
    const double angle = -kPi + kTwoPi * i / kBeams;
    const double heading = room_T_robot.yaw + angle;
    const double range = range_to(walls, room_T_robot.translation(), {std::cos(heading), std::sin(heading)});
    const double noisy = range + (0.01 + 0.005 * range) * unit(random);
    scan.beams.push_back({static_cast<float>(angle), static_cast<float>(noisy), 0.0F});
  }
  return scan;
}

std::vector<Record> drive_around() {
  std::mt19937 random(7);
  const std::vector<Wall> walls = furnished_room();
  std::vector<Record> records;
  for (int i = 0; i < kScans; ++i) {
    const Pose2 pose = pose_on_path(i);
    const Time stamp = time_at_s(kScanPeriod_s * i);
    const Eigen::Quaterniond heading(Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ()));
    records.emplace_back(ImuSample{stamp, heading});
    records.emplace_back(scan_from(walls, pose, stamp, random));
  }
  return records;
}

class MadeRecording : public Recording {
 public:
  explicit MadeRecording(const std::vector<Record>& records) : records_(records) {}

  std::optional<Record> next() override {
    if (next_ == records_.size()) return std::nullopt;
    return records_[next_++];
  }
  double progress() const override {
    return static_cast<double>(next_) / static_cast<double>(records_.size());
  }
  const std::optional<std::string>& damage() const override { return damage_; }
  const Counters& counters() const override { return counters_; }

 private:
  const std::vector<Record>& records_;
  std::size_t next_ = 0;
  std::optional<std::string> damage_;
  Counters counters_;
};

}  // namespace

std::unique_ptr<Recording> open_drawn_room() {
  static const std::vector<Record> records = drive_around();
  return std::make_unique<MadeRecording>(records);
}

}  // namespace dynslam::bench
