// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace dynslam {

enum class SimDevice { kLidar, kImu, kMotors, kCamera, kPins };
inline constexpr std::size_t kSimDevices = 5;

/// How a simulated device misbehaves.
enum class FaultKind {
  kUnplugged,  ///< every call throws DeviceError; what was measured meanwhile is lost
  kFrozen,     ///< repeats what it said last, with new stamps; a motor board heeds nothing any more
  kSilent,     ///< says nothing until the caller's time is up; motors and pins throw after their bus gives up
  kDelayed,    ///< everything comes half a second late, with its true stamp
  kNan,        ///< lidar, imu, motors: its numbers are NaN
  kInfinite,   ///< lidar, imu, motors: its numbers are infinite
  kMirrored,   ///< lidar, imu: left is right
};

inline constexpr std::array<std::string_view, kSimDevices> kSimDeviceNames = {"lidar", "imu", "motors",
                                                                              "camera", "pins"};
inline constexpr std::array<std::string_view, 7> kFaultNames = {"unplugged", "frozen",   "silent",  "delayed",
                                                                "nan",       "infinite", "mirrored"};

/// By its name in world files and on the command line.
std::optional<SimDevice> sim_device_of(std::string_view name);
std::optional<FaultKind> fault_kind_of(std::string_view name);
/// Whether a device can fail in this way: pins have no numbers that could be NaN.
bool can_have(SimDevice device, FaultKind kind);

}  // namespace dynslam
