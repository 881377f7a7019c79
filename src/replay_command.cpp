// SPDX-License-Identifier: MIT
#include "replay_command.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "grid/trinary_map.h"
#include "io/map_picture.h"
#include "io/safe_file.h"
#include "progress_bar.h"
#include "result_files.h"
#include "robot/replay.h"

namespace dynslam {
namespace {

/// Numbers that sort as they count.
std::string frame_name(std::uint64_t scans) {
  const std::string digits = std::to_string(scans);
  return "frame-" + std::string(digits.size() < 7 ? 7 - digits.size() : 0, '0') + digits + ".png";
}

void tell(const MappingResult& result, const std::string& out) {
  const double recorded_s = duration_s(result);
  std::printf("%zu scans over %.0f s, mapped in %.2f s (%.0f times real time)\n", result.trajectory.size(),
              recorded_s, result.wall_s, recorded_s / std::max(1e-3, result.wall_s));
  for (const auto& [name, n] : result.counters)
    std::printf("  %s: %llu\n", name.c_str(), static_cast<unsigned long long>(n));
  std::printf("map picture: %s/map.png\n", out.c_str());
}

}  // namespace

int run_replay(const ReplayOptions& options, const Config& config) {
  const auto recording = open_recording(options.recording, {.lidar_mount = config.lidar.mount()});
  OutputFolder out(options.out);
  MappingResult result;
  {
    ProgressBar bar(!options.quiet);
    const ReplayFrames frames{options.frames,
                              [&](std::uint64_t scans, const GridSnapshot& map, const auto& path) {
                                out.stage(frame_name(scans), to_png(trinary_map(map), {path_of(path)}));
                              }};
    result = replay(
        *recording, config.slam, [&](double share, std::uint64_t scans) { bar.show(share, scans); }, frames);
  }
  const auto& damage = recording->damage();
  if (result.inserted == 0) {
    throw InputError(damage ? *damage : options.recording + ": holds no usable scan of a lidar");
  }
  stage_results(out, result, report_of(result));
  out.commit();
  if (!options.quiet) tell(result, options.out);
  for (const std::string& finding : result.findings) spdlog::warn("{}", finding);
  if (damage) spdlog::warn("{}; what came before is mapped", *damage);
  return damage ? 2 : 0;
}

}  // namespace dynslam
