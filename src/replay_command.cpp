// SPDX-License-Identifier: MIT
#include "replay_command.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include "grid/trinary_map.h"
#include "io/map_file.h"
#include "io/map_picture.h"
#include "io/safe_file.h"
#include "progress_bar.h"
#include "robot/replay.h"

namespace dynslam {
namespace {

/// Time from scan to scan, summed up; where the clock was set back or leapt a day, nothing is added.
double duration_s(const ReplayResult& result) {
  double sum = 0.0;
  for (std::size_t i = 1; i < result.trajectory.size(); ++i) {
    const double step = to_seconds(result.trajectory[i].stamp - result.trajectory[i - 1].stamp);
    if (step > 0 && step < 86400) sum += step;
  }
  return sum;
}

long peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024L;
}

nlohmann::json spread(std::vector<float> ms) {
  std::sort(ms.begin(), ms.end());
  const auto at = [&](double share) {
    return ms.empty() ? 0.0F : ms[static_cast<std::size_t>(share * static_cast<double>(ms.size() - 1))];
  };
  const double sum = std::accumulate(ms.begin(), ms.end(), 0.0);
  return {{"mean", ms.empty() ? 0.0 : sum / static_cast<double>(ms.size())},
          {"p50", at(0.5)},
          {"p99", at(0.99)},
          {"max", at(1.0)}};
}

nlohmann::json report(const ReplayResult& result) {
  nlohmann::json counters = nlohmann::json::object();
  for (const auto& [name, n] : result.counters) counters[name] = n;
  const std::size_t scans = result.trajectory.size();
  return {{"scans", scans},
          {"inserted", result.inserted},
          {"skipped", scans - result.inserted},
          {"duration_s", duration_s(result)},
          {"wall_s", result.wall_s},
          {"cpu_s", result.cpu_s},
          {"peak_rss_bytes", peak_rss_bytes()},
          {"scan_ms", spread(result.scan_ms)},
          {"stages_ms", result.stages_ms},
          {"local_maps", result.local_maps},
          {"active_local_maps", result.local_maps_active},
          {"loop_closures", result.loop_closures},
          {"map",
           {{"cell_size_m", result.map.cell_size_m()},
            {"chunks", result.map.chunk_count()},
            {"bytes", result.map_bytes}}},
          {"findings", result.findings},
          {"counters", counters}};
}

std::vector<Vector2> path_of(const std::vector<StampedPose>& poses) {
  std::vector<Vector2> path;
  path.reserve(poses.size());
  for (const StampedPose& p : poses) path.push_back(p.map_T_robot.translation());
  return path;
}

/// Numbers that sort as they count.
std::string frame_name(std::uint64_t scans) {
  const std::string digits = std::to_string(scans);
  return "frame-" + std::string(digits.size() < 7 ? 7 - digits.size() : 0, '0') + digits + ".png";
}

void write_results(OutputFolder& out, ReplayResult& result) {
  const nlohmann::json figures = report(result);
  out.stage("trajectory.tum", to_tum(result.trajectory));
  out.stage("trajectory_live.tum", to_tum(result.trajectory_live));
  MapPictureLayers layers;
  layers.path_map = path_of(result.trajectory);
  const TrinaryMap map = trinary_map(result.map);
  result.map = {};  // the cells were copied: on a small computer the memory is better used for the picture
  out.stage("map.pgm", [&](const ByteSink& sink) { write_pgm(map, sink); });
  out.stage("map.yaml", to_map_yaml(map, "map.pgm"));
  out.stage("map.png", to_png(map, layers));
  result.graph.path_map = std::move(layers.path_map);
  out.stage("graph.svg", to_svg(result.graph, map));
  out.stage("report.json", figures.dump(2) + "\n");
  out.commit();
}

void tell(const ReplayResult& result, const std::string& out) {
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
  ReplayResult result;
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
  write_results(out, result);
  if (!options.quiet) tell(result, options.out);
  for (const std::string& finding : result.findings) spdlog::warn("{}", finding);
  if (damage) spdlog::warn("{}; what came before is mapped", *damage);
  return damage ? 2 : 0;
}

}  // namespace dynslam
