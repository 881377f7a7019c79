// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace dynslam {

/// What the pins say; wires that are broken read as pressed.
struct PinState {
  bool estop_pressed = false;
  std::optional<bool> bumper_pressed = {};  ///< any of them; nothing when the robot has none
};

}  // namespace dynslam
