// SPDX-License-Identifier: MIT
#pragma once

namespace dynslam {

/// What the pins say; wires that are broken read as pressed.
struct PinState {
  bool estop_pressed = false;
};

}  // namespace dynslam
