// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Geometry>

namespace dynslam::bno055 {

/// Of page 0. Numbers are int16, low byte first.
enum Register : std::uint8_t {
  kIdentityRegister = 0x00,
  kPage = 0x07,
  kAcceleration = 0x08,
  kMotion = 0x14,  ///< gyroscope, Euler angles, quaternion
  kStatus = 0x34,
  kUnits = 0x3b,
  kMode = 0x3d,
  kPower = 0x3e,
  kTrigger = 0x3f,
  kAxisMap = 0x41,  ///< and signs after it
  kProfile = 0x55,
};

constexpr std::uint8_t kChip = 0xa0;
constexpr std::uint8_t kConfigMode = 0x00, kImuMode = 0x08, kNdofMode = 0x0c;
constexpr std::uint8_t kResetBit = 0x20, kCrystalBit = 0x80;

using IdentityBytes = std::array<std::uint8_t, 7>;
using MotionBytes = std::array<std::uint8_t, 20>;
using StatusBytes = std::array<std::uint8_t, 10>;

struct Identity {
  std::uint8_t chip = 0, accelerometer = 0, magnetometer = 0, gyroscope = 0;
  int software = 0;  ///< 0x0311 is 3.17
  int bootloader = 0;

  /// Whether all parts are those of a BNO055.
  bool is_usual() const {
    return chip == kChip && accelerometer == 0xfb && magnetometer == 0x32 && gyroscope == 0x0f;
  }
};
Identity decode_identity(const IdentityBytes& bytes);

/// World: z up, heading arbitrary. Both are right-handed, unlike the chip's Euler angles.
struct Motion {
  Eigen::Quaterniond world_q_robot = Eigen::Quaterniond::Identity();  ///< of unit length
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();
};

/// Why a reading is none.
enum class Nonsense {
  kNone,
  kAllZero,  ///< as the chip says while it is not fusing
  kAllOnes,  ///< as a bus says that nobody pulls down
  kLength,   ///< of the quaternion
  kRate,     ///< jumped, or beyond what the gyroscope can measure
  kJump,     ///< of the orientation
};
std::string_view to_string(Nonsense nonsense);

/// A 20 byte burst from kMotion on, and what is wrong with it by itself.
struct MotionReading {
  Nonsense nonsense = Nonsense::kNone;
  Motion motion;
};
MotionReading decode_motion(const MotionBytes& bytes);

/// How well each part is calibrated, 0 to 3.
struct Calibration {
  int system = 0, gyroscope = 0, accelerometer = 0, magnetometer = 0;
};

struct Status {
  int temperature_c = 0;
  Calibration calibration;
  bool self_tests_passed = false;
  int system = 0;  ///< 5: fusing
  int error = 0;
  int mode = 0;

  bool is_fusing(std::uint8_t wanted_mode) const { return system == 5 && mode == wanted_mode; }
};
/// A 10 byte burst from kStatus on. Nothing for what no chip in a room says: all zero, all ones, hot, in a
/// mode or state that does not exist.
std::optional<Status> decode_status(const StatusBytes& bytes);
/// What Status::error means.
std::string_view error_words(int error);

/// What to write to kAxisMap on, so that the chip speaks of the robot's axes.
struct AxisMap {
  std::uint8_t map = 0x24, signs = 0x00;
  bool operator==(const AxisMap&) const = default;
};
/// `forward` and `up` say which of the chip's axes points there: "x", "-y" and so on. Nothing when these are
/// no axes, or not at right angles.
std::optional<AxisMap> axis_map(std::string_view forward, std::string_view up);

}  // namespace dynslam::bno055
