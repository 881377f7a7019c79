// SPDX-License-Identifier: MIT
#pragma once

namespace dynslam::bench {

void register_memory_benchmarks();
void register_clear_benchmarks();
void register_match_benchmarks();
void register_map_benchmarks();
void register_cast_benchmarks();
void register_replay_benchmarks();
void register_back_end_benchmarks();
void register_drive_benchmarks();
void register_plan_benchmarks();
void register_autopilot_benchmarks();
void register_rplidar_benchmarks();

}  // namespace dynslam::bench
