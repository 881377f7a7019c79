// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace dynslam::rplidar {

/// The serial ports in a folder as udev's /dev/serial/by-id that a lidar may be at, in order of name: those
/// of the adapter that such lidars come with (CP210x), or else the only one there is. Empty without any.
std::vector<std::string> find_ports(const std::string& folder);

}  // namespace dynslam::rplidar
