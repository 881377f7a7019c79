// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace dynslam {

/// The computer that this runs on, as far as it tells.
struct Machine {
  std::string model;         ///< "Raspberry Pi 4 Model B Rev 1.4", or that of its processor
  std::string architecture;  ///< "aarch64"
  std::string governor;      ///< what sets its speed, as "ondemand"; empty: nothing that it tells of
  unsigned cores = 0;
  int most_mhz = 0, memory_mib = 0;  ///< 0: not told
  std::optional<double> temperature_c = {};
  std::optional<std::uint32_t> throttled = {};  ///< see PiFlags
  std::vector<std::string> advice = {};         ///< see PiState
};

/// `root` is where /proc and /sys are.
Machine this_machine(const std::filesystem::path& root = "/");

}  // namespace dynslam
