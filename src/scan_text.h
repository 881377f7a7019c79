// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "base/scan.h"

namespace dynslam {

/// A scan as a picture in text, the robot in the middle, its front up; `radius_m` to each side, twice as many
/// columns as rows. Lines end in newlines.
std::string scan_text(const Scan& scan, double radius_m, int rows = 21);

}  // namespace dynslam
