// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace dynslam::bno055 {

/// The 22 bytes from kProfile on: offsets of accelerometer, magnetometer and gyroscope, x y z each, then the
/// radii of the first two; int16, low byte first.
using Profile = std::array<std::uint8_t, 22>;

/// Whether a chip can have found it: a profile out of range makes it refuse to fuse.
bool is_possible(const Profile& profile);

/// One line with a checksum: "bno055 1 HEX CHECKSUM".
std::string profile_text(const Profile& profile);
/// Nothing when it is not such a line, its checksum is wrong or what it says is not possible.
std::optional<Profile> read_profile(std::string_view text);

}  // namespace dynslam::bno055

namespace dynslam {

/// Where a calibration profile outlasts the robot's power. Both may be empty, and are called by the thread
/// that uses the IMU.
struct ProfileStore {
  std::function<std::optional<std::string>()> load;  ///< what was saved last, if anything
  std::function<void(const std::string&)> save;      ///< all of it or nothing; may throw
};

}  // namespace dynslam
