// SPDX-License-Identifier: MIT
#include "io/trajectory.h"

#include <cmath>
#include <cstdint>

#include "base/number_text.h"

namespace dynslam {
namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

// Through integers: a double of seconds since 1970 cannot tell two neighbouring nanoseconds apart.
void append_seconds(std::string& text, Time stamp) {
  const std::int64_t count = stamp.time_since_epoch().count();
  const std::int64_t whole = count / kNanoseconds;
  const std::string fraction = std::to_string(std::abs(count % kNanoseconds));
  if (count < 0 && whole == 0) text += '-';
  text += std::to_string(whole);
  text += '.';
  text.append(9 - fraction.size(), '0');
  text += fraction;
}

}  // namespace

std::string to_tum(const std::vector<StampedPose>& trajectory) {
  std::string text;
  text.reserve(trajectory.size() * 80);
  for (const auto& [stamp, pose] : trajectory) {
    append_seconds(text, stamp);
    for (const double metres : {pose.x, pose.y}) {
      text += ' ';
      append_fixed(text, metres, 6);
    }
    text += " 0 0 0 ";
    append_fixed(text, std::sin(pose.yaw / 2.0), 9);
    text += ' ';
    append_fixed(text, std::cos(pose.yaw / 2.0), 9);
    text += '\n';
  }
  return text;
}

}  // namespace dynslam
