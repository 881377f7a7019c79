// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace dynslam {

/// What the user gave cannot be used: a file, an option, a value. The message is one line that names file and
/// place. The program ends with exit code 2; any other exception ends it with 1.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace dynslam
