// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "slam/hit_window.h"
#include "slam/passes.h"

namespace dynslam {

/// What a scan has to offer for matching: its hits, in the robot's frame and in cells; at most some 2000 of
/// them, evenly. Where neighbouring ends are dots on a straight surface they know which way it runs.
void choose_points(const CorrectedScan& scan, double cell_size_m, std::vector<MatchPoint>& points);

}  // namespace dynslam
