// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "base/pose2.h"

namespace dynslam {

/// Cuts a line of a CARMEN log into words and numbers, independent of the locale.
class CarmenWords {
 public:
  explicit CarmenWords(std::string_view line) : rest_(line) {}

  /// The next word; empty at the end of the line.
  std::string_view word();

  /// Reads a number, which may be nan or inf. False, and the value untouched, if the next word is none.
  bool number(double& value);
  bool number(std::size_t& value);
  bool pose(Pose2& value) { return number(value.x) && number(value.y) && number(value.yaw); }
  bool skip_numbers(int count);

  std::string_view rest() const { return rest_; }

 private:
  template <class T>
  bool parse(T& value);
  void skip_spaces();

  std::string_view rest_;
};

/// FLASER or ROBOTLASER1 as written: nothing checked but that the numbers are numbers. Poses may hold any
/// value.
struct CarmenLaser {
  struct Fan {
    double start_angle_rad = 0.0;
    double fov_rad = 0.0;
    double step_rad = 0.0;
    double max_range_m = 0.0;
  };
  std::optional<Fan> fan;  ///< ROBOTLASER1 only
  std::vector<float> ranges_m;
  std::optional<Pose2> laser;  ///< ROBOTLASER1 only, in the same frame as `robot`
  Pose2 robot;                 ///< raw odometry
  double stamp_s = 0.0;        ///< when the laser's driver sent it
};

struct CarmenOdometry {
  Pose2 robot;
  double stamp_s = 0.0;
};

/// What follows the message's name. Nothing if a number is missing or none, or a count does not fit the line.
/// `must_be_whole`: the line ended without a newline, so that only its very last word may have been cut.
std::optional<CarmenLaser> parse_flaser(CarmenWords words, bool must_be_whole);
std::optional<CarmenLaser> parse_robotlaser1(CarmenWords words, bool must_be_whole);
std::optional<CarmenOdometry> parse_odom(CarmenWords words, bool must_be_whole);

}  // namespace dynslam
