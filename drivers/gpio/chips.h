// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "drivers/gpio/lines.h"

namespace dynslam {

/// All chips of this computer, in the order of their numbers.
std::vector<ChipInfo> list_chips();

/// The path of the chip that is `wanted`: its path, its name ("gpiochip0") or its label; "auto" is the one
/// that a Raspberry Pi's header hangs on, whatever its number. Throws DeviceError.
std::string choose_chip(std::span<const ChipInfo> chips, const std::string& wanted, const std::string& who);

inline std::string find_chip(const std::string& wanted, const std::string& who) {
  return choose_chip(list_chips(), wanted, who);
}

/// What went wrong with a chip, or with a line of it, and what to do about it; `error` is an errno.
DeviceError chip_error(const std::string& who, const std::string& path, int error);
DeviceError line_error(const std::string& who, const std::string& path, unsigned offset, int error);

}  // namespace dynslam
