// SPDX-License-Identifier: MIT
#include "tools/jitter/tum_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/imu_sample.h"
#include "io/line_reader.h"

namespace dynslam::jitter {
namespace {

constexpr double kLengthSlack = 0.05;  // of a quaternion; beyond, the columns are something else

/// The line up to a comment, without leading space.
std::string_view content_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  return line;
}

/// Throws InputError, which says only what is wrong.
StampedPose parse(std::string_view line) {
  std::istringstream words{std::string(line)};
  words.imbue(std::locale::classic());
  std::array<double, 8> n{};
  for (double& number : n) words >> number;
  std::string rest;
  if (!words || words >> rest) throw InputError("want 8 numbers: t x y z qx qy qz qw");
  if (!is_representable_s(n[0])) throw InputError("the time is out of range");
  const Eigen::Quaterniond q(n[7], n[4], n[5], n[6]);
  if (!(std::abs(q.norm() - 1.0) < kLengthSlack))
    throw InputError("the quaternion's length is not 1: are the columns t x y z qx qy qz qw?");
  return {time_at_s(n[0]), {n[1], n[2], yaw_of(q.normalized())}};
}

}  // namespace

std::vector<StampedPose> read_tum(ByteSource& source) {
  std::vector<StampedPose> trajectory;
  LineReader lines(source);
  while (const auto line = lines.next()) {
    const std::string_view content = content_of(line->text);
    if (content.empty() && !line->too_long) continue;
    try {
      trajectory.push_back(parse(content));
    } catch (const InputError& e) {
      throw InputError(source.name() + ":" + std::to_string(lines.line_number()) + ": " + e.what());
    }
  }
  if (!lines.fault().empty()) throw InputError(source.name() + ": " + lines.fault());
  if (trajectory.empty()) throw InputError(source.name() + ": holds no pose");
  return trajectory;
}

}  // namespace dynslam::jitter
