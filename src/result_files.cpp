// SPDX-License-Identifier: MIT
#include "result_files.h"

#include <algorithm>
#include <numeric>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "grid/trinary_map.h"
#include "io/map_file.h"
#include "io/map_picture.h"

namespace dynslam {
namespace {

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

}  // namespace

double duration_s(const MappingResult& result) {
  double sum = 0.0;
  for (std::size_t i = 1; i < result.trajectory.size(); ++i) {
    const double step = to_seconds(result.trajectory[i].stamp - result.trajectory[i - 1].stamp);
    if (step > 0 && step < 86400) sum += step;
  }
  return sum;
}

std::vector<Vector2> path_of(const std::vector<StampedPose>& poses) {
  std::vector<Vector2> path;
  path.reserve(poses.size());
  for (const StampedPose& p : poses) path.push_back(p.map_T_robot.translation());
  return path;
}

nlohmann::json report_of(const MappingResult& result) {
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

void stage_results(OutputFolder& out, MappingResult& result, const nlohmann::json& report) {
  out.stage("trajectory.tum", to_tum(result.trajectory));
  out.stage("trajectory_live.tum", to_tum(result.trajectory_live));
  MapPictureLayers layers;
  layers.path_map = path_of(result.trajectory);
  layers.route_map = result.route_map;
  layers.places_map = result.places_map;
  const TrinaryMap map = trinary_map(result.map);
  result.map = {};  // the cells were copied: on a small computer the memory is better used for the picture
  out.stage("map.pgm", [&](const ByteSink& sink) { write_pgm(map, sink); });
  out.stage("map.yaml", to_map_yaml(map, "map.pgm"));
  out.stage("map.png", to_png(map, layers));
  result.graph.path_map = std::move(layers.path_map);
  out.stage("graph.svg", to_svg(result.graph, map));
  out.stage("report.json", report.dump(2) + "\n");
}

}  // namespace dynslam
