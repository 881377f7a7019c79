// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "io/safe_file.h"
#include "robot/mapping_result.h"

namespace dynslam {

/// Time from scan to scan, summed up; where the clock was set back or leapt a day, nothing is added.
double duration_s(const MappingResult& result);

std::vector<Vector2> path_of(const std::vector<StampedPose>& poses);

/// What report.json says of a result.
nlohmann::json report_of(const MappingResult& result);

/// Stages trajectories, map, pictures and the report. Takes the map out of the result.
void stage_results(OutputFolder& out, MappingResult& result, const nlohmann::json& report);

}  // namespace dynslam
