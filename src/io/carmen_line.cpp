// SPDX-License-Identifier: MIT
#include "io/carmen_line.h"

#include <charconv>

#include "io/scan_limits.h"

namespace dynslam {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t'; }

bool parse_ranges(CarmenWords& words, std::vector<float>& ranges_m) {
  std::size_t count = 0;
  if (!words.number(count)) return false;
  // A reading takes a space and a digit at least: the line itself bounds what is reserved.
  if (count > kMaxBeams || count > words.rest().size() / 2) return false;
  ranges_m.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    double range = 0.0;
    if (!words.number(range)) return false;
    ranges_m.push_back(static_cast<float>(range));
  }
  return true;
}

/// `ipc_timestamp host logger_timestamp`. Some converters leave out the last two; on a line without its end,
/// their absence would mean that the stamp may lack digits.
bool parse_stamp(CarmenWords& words, bool must_be_whole, double& stamp_s) {
  if (!words.number(stamp_s)) return false;
  if (!must_be_whole) return true;
  double logger_stamp = 0.0;
  return !words.word().empty() && words.number(logger_stamp);
}

}  // namespace

void CarmenWords::skip_spaces() {
  std::size_t spaces = 0;
  while (spaces < rest_.size() && is_space(rest_[spaces])) ++spaces;
  rest_.remove_prefix(spaces);
}

std::string_view CarmenWords::word() {
  skip_spaces();
  std::size_t length = 0;
  while (length < rest_.size() && !is_space(rest_[length])) ++length;
  const std::string_view result = rest_.substr(0, length);
  rest_.remove_prefix(length);
  return result;
}

template <class T>
bool CarmenWords::parse(T& value) {
  skip_spaces();
  const char* end = rest_.data() + rest_.size();
  const auto [stop, error] = std::from_chars(rest_.data(), end, value);
  if (error != std::errc() || (stop != end && !is_space(*stop))) return false;
  rest_.remove_prefix(static_cast<std::size_t>(stop - rest_.data()));
  return true;
}

bool CarmenWords::number(double& value) { return parse(value); }
bool CarmenWords::number(std::size_t& value) { return parse(value); }

bool CarmenWords::skip_numbers(int count) {
  double ignored = 0.0;
  for (int i = 0; i < count; ++i) {
    if (!number(ignored)) return false;
  }
  return true;
}

// n r1..rn x y theta odom_x odom_y odom_theta ipc_timestamp host logger_timestamp. The first pose is the
// robot's as some localiser may have corrected it; only the second is raw.
std::optional<CarmenLaser> parse_flaser(CarmenWords words, bool must_be_whole) {
  CarmenLaser laser;
  const bool good = parse_ranges(words, laser.ranges_m) && words.skip_numbers(3) && words.pose(laser.robot) &&
                    parse_stamp(words, must_be_whole, laser.stamp_s);
  if (!good) return std::nullopt;
  return laser;
}

// laser_type start_angle field_of_view angular_resolution maximum_range accuracy remission_mode n r1..rn m
// m1..mm laser_x laser_y laser_theta robot_x robot_y robot_theta tv rv forward_safety_dist side_safety_dist
// turn_axis ipc_timestamp host logger_timestamp
std::optional<CarmenLaser> parse_robotlaser1(CarmenWords words, bool must_be_whole) {
  CarmenLaser laser;
  CarmenLaser::Fan fan;
  Pose2 pose;
  std::size_t remissions = 0;
  const bool good_head = words.skip_numbers(1) && words.number(fan.start_angle_rad) &&
                         words.number(fan.fov_rad) && words.number(fan.step_rad) &&
                         words.number(fan.max_range_m) && words.skip_numbers(2);
  const bool good_ranges = good_head && parse_ranges(words, laser.ranges_m) && words.number(remissions) &&
                           remissions <= kMaxBeams && words.skip_numbers(static_cast<int>(remissions));
  const bool good_tail = good_ranges && words.pose(pose) && words.pose(laser.robot) &&
                         words.skip_numbers(5) && parse_stamp(words, must_be_whole, laser.stamp_s);
  if (!good_tail) return std::nullopt;
  laser.fan = fan;
  laser.laser = pose;
  return laser;
}

// x y theta tv rv accel ipc_timestamp host logger_timestamp
std::optional<CarmenOdometry> parse_odom(CarmenWords words, bool must_be_whole) {
  CarmenOdometry odometry;
  const bool good = words.pose(odometry.robot) && words.skip_numbers(3) &&
                    parse_stamp(words, must_be_whole, odometry.stamp_s);
  if (!good) return std::nullopt;
  return odometry;
}

}  // namespace dynslam
