// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace dynslam {

/// A device does not do what it was asked to: unplugged, silent, talking nonsense. One line that names the
/// device and what to look at. The caller may go on asking: the device tries to come back by itself.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace dynslam
