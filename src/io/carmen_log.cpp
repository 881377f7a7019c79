// SPDX-License-Identifier: MIT
#include "io/carmen_log.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/scan_limits.h"

namespace dynslam {
namespace {

constexpr double kNoReturn = 80.0;   // metres: a SICK says 81.83, 81.91 and the like when nothing came back
constexpr double kMountReach = 5.0;  // metres: beyond, the two poses of a ROBOTLASER1 are of different origin

constexpr std::string_view kKnownMessages[] = {
    "PARAM",     "ODOM",      "FLASER",    "RLASER", "ROBOTLASER1", "ROBOTLASER2", "RAWLASER1",
    "RAWLASER2", "RAWLASER3", "RAWLASER4", "LASER3", "LASER4",      "SYNC",        "TRUEPOS",
    "NMEAGGA",   "NMEARMC",   "IMU",       "BUMPER", "SONAR",       "MARKER"};

bool is_message_name(std::string_view word) {
  return std::find(std::begin(kKnownMessages), std::end(kKnownMessages), word) != std::end(kKnownMessages);
}

bool is_default(const LidarMount& mount) { return mount.robot_T_lidar == Pose2{} && !mount.upside_down; }

bool are_same(const Pose2& a, const Pose2& b) {
  constexpr double kPrinted = 2e-6;  // the last digit of what CARMEN prints
  return std::abs(a.x - b.x) < kPrinted && std::abs(a.y - b.y) < kPrinted &&
         std::abs(turn(a.yaw, b.yaw)) < kPrinted;
}

/// What a FLASER leaves unsaid. The readings of a SICK run over its whole field of view, the end beam
/// included: 181 at one degree. But many drivers drop the last one to have a round 180 or 360, and the others
/// stay where they are; so CARMEN's own reader has it, and logs of 180 readings lose half a degree of heading
/// when it is missed.
CarmenLaser::Fan fan_of(std::size_t beams, std::optional<double> fov_rad) {
  const bool is_narrow = beams == 400 || beams == 401;  // the 100 degree mode, in quarter degrees
  const double usual = is_narrow ? radians(100.0) : kPi;
  double fov = fov_rad.value_or(usual);
  const bool last_is_dropped = beams == 180 || beams == 360 || beams == 400;
  if (last_is_dropped && std::abs(fov - usual) < radians(1.1)) {
    return {-usual / 2.0, usual, usual / static_cast<double>(beams), kNoReturn};
  }
  if (beams < 2) return {0.0, fov, 0.0, kNoReturn};
  return {-fov / 2.0, fov, fov / static_cast<double>(beams - 1), kNoReturn};
}

}  // namespace

CarmenLog::CarmenLog(std::unique_ptr<ByteSource> source, const RecordingConfig& config)
    : source_(std::move(source)),
      config_mount_(config.lidar_mount),
      lines_(*source_),
      params_{{}, kNoReturn},
      skipped_(counters_, "carmen.skipped") {}

bool CarmenLog::looks_right() {
  std::string_view text = lines_.peek();
  while (!text.empty()) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, length);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (is_message_name(CarmenWords(line).word())) return true;
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return false;
}

double CarmenLog::progress() const {
  if (ended_ || source_->size() == 0) return 1.0;
  return std::min(1.0, static_cast<double>(source_->position()) / static_cast<double>(source_->size()));
}

std::optional<Record> CarmenLog::next() {
  while (true) {
    for (std::optional<Record>& record : ready_) {
      if (record) return std::exchange(record, std::nullopt);
    }
    if (ended_) return std::nullopt;
    const std::optional<Line> line = lines_.next();
    if (!line) {
      finish();
    } else if (!take(*line)) {
      counters_.add("carmen.bad_lines");
      if (first_bad_line_ == 0) first_bad_line_ = lines_.line_number();
    }
  }
}

void CarmenLog::finish() {
  ended_ = true;
  if (!lines_.fault().empty()) {
    damage_ = source_->name() + ": " + lines_.fault() + ", after " + std::to_string(lines_.line_number()) +
              " lines and " + std::to_string(scans_) + " scans";
  } else if (scans_ == 0 && first_bad_line_ > 0) {
    damage_ = source_->name() + ": no scan could be read; the first damaged line is number " +
              std::to_string(first_bad_line_);
  }
}

bool CarmenLog::take(const Line& line) {
  if (line.too_long) return false;
  CarmenWords words(line.text);
  const std::string_view name = words.word();
  const bool must_be_whole = !line.has_newline;
  if (name.empty() || name.front() == '#') return true;
  if (name == "PARAM") return take_param(words);
  if (name == "ODOM") return take_odometry(parse_odom(words, must_be_whole));
  const bool is_used = laser_name_.empty() || name == laser_name_;
  if (name == "FLASER" && is_used) return take_laser(name, parse_flaser(words, must_be_whole));
  if (name == "ROBOTLASER1" && is_used) return take_laser(name, parse_robotlaser1(words, must_be_whole));
  skipped_.add(name);
  return true;
}

bool CarmenLog::take_odometry(const std::optional<CarmenOdometry>& odometry) {
  if (!odometry || !is_representable_s(odometry->stamp_s)) return false;
  deliver(odometry->robot, odometry->stamp_s);
  return true;
}

bool CarmenLog::take_laser(std::string_view name, const std::optional<CarmenLaser>& laser) {
  if (!laser || !is_representable_s(laser->stamp_s)) return false;
  std::optional<Scan> scan = make_scan(*laser);
  if (!scan) return false;
  deliver(laser->robot, laser->stamp_s);
  ready_[1] = std::move(*scan);
  laser_name_ = name;
  ++scans_;
  return true;
}

void CarmenLog::deliver(const Pose2& odom_T_robot, double stamp_s) {
  if (!is_finite(odom_T_robot)) {
    counters_.add("carmen.bad_odometry");
    return;
  }
  const Pose2 wrapped{odom_T_robot.x, odom_T_robot.y, wrap_angle(odom_T_robot.yaw)};
  ready_[0] = OdometrySample{time_at_s(stamp_s), wrapped};
}

std::optional<Scan> CarmenLog::make_scan(const CarmenLaser& laser) {
  const std::size_t beams = laser.ranges_m.size();
  CarmenLaser::Fan fan = laser.fan.value_or(fan_of(beams, params_.fov_rad));
  if (laser.fan && fan.step_rad == 0.0 && beams > 1)
    fan.step_rad = fan.fov_rad / static_cast<double>(beams - 1);
  if (!is_plausible_fan(fan.start_angle_rad, fan.step_rad, beams)) return std::nullopt;
  const double said =
      fan.max_range_m > 0.0 ? std::min(fan.max_range_m, params_.max_range_m) : params_.max_range_m;
  const auto max_range = static_cast<float>(said);

  Scan scan{time_at_s(laser.stamp_s), {}, mount_of(laser)};
  scan.beams.reserve(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const double angle = fan.start_angle_rad + static_cast<double>(i) * fan.step_rad;
    scan.beams.push_back({static_cast<float>(angle), clean_range(laser.ranges_m[i], 0.0F, max_range), 0.0F});
  }
  return scan;
}

LidarMount CarmenLog::mount_of(const CarmenLaser& laser) {
  LidarMount mount = config_mount_;
  if (is_default(mount)) mount = {{params_.mount_x_m, 0.0, 0.0}, params_.flipped};
  if (!laser.laser || are_same(*laser.laser, laser.robot)) return mount;
  const Pose2 robot_T_lidar = laser.robot.inverse() * *laser.laser;
  if (is_finite(robot_T_lidar) && robot_T_lidar.translation().norm() < kMountReach) {
    mount.robot_T_lidar = robot_T_lidar;
  } else {
    counters_.add("carmen.bad_mount");
  }
  return mount;
}

/// `PARAM name value ...`. One that is not of interest may hold anything.
bool CarmenLog::take_param(CarmenWords words) {
  const std::string_view name = words.word();
  CarmenWords value_word(words.word());
  if (name == "laser_front_laser_flipped") {
    const std::string_view word = value_word.word();
    params_.flipped = word == "1" || word == "on";
    return true;
  }
  const bool is_fov = name == "laser_front_laser_fov";
  const bool is_offset = name == "robot_frontlaser_offset";
  const bool is_max = name == "robot_front_laser_max" || name == "laser_front_laser_max";
  if (!is_fov && !is_offset && !is_max) return true;
  double value = 0.0;
  if (!value_word.number(value) || !std::isfinite(value)) return false;
  if (is_offset && std::abs(value) < kMountReach) params_.mount_x_m = value;
  if (is_max && value > 0.0) params_.max_range_m = std::min(value, kNoReturn);
  // Later versions of CARMEN write degrees here.
  const double fov = value > kTwoPi + 1e-3 ? radians(value) : value;
  if (is_fov && fov > 0.0 && fov <= kTwoPi + 1e-3) params_.fov_rad = fov;
  return true;
}

}  // namespace dynslam
