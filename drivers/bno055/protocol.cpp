// SPDX-License-Identifier: MIT
#include "drivers/bno055/protocol.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace dynslam::bno055 {
namespace {

constexpr double kGyroscopeSteps_per_degps = 16.0;
constexpr double kGyroscopeRange_radps = radians(2000.0);
constexpr double kQuaternionSteps = 16384.0;
constexpr double kLengthTolerance = 0.02;
constexpr std::size_t kQuaternionAt = 12;  ///< in MotionBytes, after gyroscope and Euler angles

double number_at(std::span<const std::uint8_t> bytes, std::size_t i) {
  return static_cast<std::int16_t>(bytes[i] | bytes[i + 1] << 8);
}

template <class Bytes>
bool all_are(const Bytes& bytes, std::uint8_t value) {
  return std::all_of(bytes.begin(), bytes.end(), [&](std::uint8_t b) { return b == value; });
}

/// "x", "y", "z", with a minus or not.
std::optional<Eigen::Vector3i> axis_of(std::string_view text) {
  const bool minus = text.starts_with('-');
  if (minus) text.remove_prefix(1);
  if (text.size() != 1 || text[0] < 'x' || text[0] > 'z') return std::nullopt;
  Eigen::Vector3i axis = Eigen::Vector3i::Zero();
  axis[text[0] - 'x'] = minus ? -1 : 1;
  return axis;
}

}  // namespace

Identity decode_identity(const IdentityBytes& b) { return {b[0], b[1], b[2], b[3], b[4] | b[5] << 8, b[6]}; }

MotionReading decode_motion(const MotionBytes& bytes) {
  if (all_are(bytes, 0x00)) return {Nonsense::kAllZero, {}};
  if (all_are(bytes, 0xff)) return {Nonsense::kAllOnes, {}};
  const auto q = [&](std::size_t i) { return number_at(bytes, kQuaternionAt + 2 * i) / kQuaternionSteps; };
  const auto rate = [&](std::size_t i) {
    return radians(number_at(bytes, 2 * i) / kGyroscopeSteps_per_degps);
  };
  const Eigen::Quaterniond world_q_robot(q(0), q(1), q(2), q(3));
  const Eigen::Vector3d rate_radps(rate(0), rate(1), rate(2));
  if (std::abs(world_q_robot.norm() - 1.0) > kLengthTolerance) return {Nonsense::kLength, {}};
  if (rate_radps.cwiseAbs().maxCoeff() > kGyroscopeRange_radps) return {Nonsense::kRate, {}};
  return {Nonsense::kNone, {world_q_robot.normalized(), rate_radps}};
}

std::string_view to_string(Nonsense nonsense) {
  constexpr std::array<std::string_view, 6> kWords{"sense", "all-zero", "all-ones", "length", "rate", "jump"};
  return kWords[static_cast<std::size_t>(nonsense)];
}

std::optional<Status> decode_status(const StatusBytes& b) {
  if (all_are(b, 0x00) || all_are(b, 0xff)) return std::nullopt;
  Status s;
  s.temperature_c = static_cast<std::int8_t>(b[0]);
  const auto quality = [&](int shift) { return b[1] >> shift & 3; };
  s.calibration = {quality(6), quality(4), quality(2), quality(0)};
  s.self_tests_passed = (b[2] & 0x0f) == 0x0f;
  s.system = b[5];
  s.error = b[6];
  s.mode = b[9];
  const bool possible = s.temperature_c >= -40 && s.temperature_c <= 85 && s.system <= 6 && s.error <= 10 &&
                        s.mode <= kNdofMode;
  return possible ? std::optional(s) : std::nullopt;
}

std::string_view error_words(int error) {
  constexpr std::array<std::string_view, 11> kWords{"no error",
                                                    "its parts do not start",
                                                    "its system does not start",
                                                    "self-test failed",
                                                    "register value refused",
                                                    "register address refused",
                                                    "register write refused",
                                                    "low power mode refused",
                                                    "accelerometer's power mode refused",
                                                    "fusion refuses its configuration",
                                                    "sensor refuses its configuration"};
  return error >= 0 && error < static_cast<int>(kWords.size()) ? kWords[static_cast<std::size_t>(error)]
                                                               : "unknown error";
}

std::optional<AxisMap> axis_map(std::string_view forward, std::string_view up) {
  const auto x = axis_of(forward), z = axis_of(up);
  if (!x || !z || x->dot(*z) != 0) return std::nullopt;
  const std::array<Eigen::Vector3i, 3> robot_axes{*x, z->cross(*x), *z};
  int map = 0, signs = 0;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3i& axis = robot_axes[static_cast<std::size_t>(i)];
    const int chip_axis = axis[1] != 0 ? 1 : axis[2] != 0 ? 2 : 0;
    map |= chip_axis << 2 * i;
    if (axis.sum() < 0) signs |= 4 >> i;
  }
  return AxisMap{static_cast<std::uint8_t>(map), static_cast<std::uint8_t>(signs)};
}

}  // namespace dynslam::bno055
