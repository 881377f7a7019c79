// SPDX-License-Identifier: MIT
// Whole recordings: read and mapped, or only read; and what the map takes in memory for what it knows.
#include <string>

#include <benchmark/benchmark.h>

#include "bench/benchmarks.h"
#include "bench/scan_source.h"
#include "robot/replay.h"

namespace dynslam::bench {
namespace {

std::size_t cells_known(const Chunk& chunk) {
  std::size_t known = 0;
  for (int y = 0; y < kChunkSide; ++y) {
    for (int x = 0; x < kChunkSide; ++x) known += (chunk.hit[y][x] | chunk.miss[y][x]) != 0 ? 1 : 0;
  }
  return known;
}

/// Cells that a scan touched at least once: a look leaves something in one of the two bytes.
std::size_t cells_known(const GridSnapshot& map) {
  std::size_t known = 0;
  for (std::int32_t y = map.box().min.y; y <= map.box().max.y; ++y) {
    for (std::int32_t x = map.box().min.x; x <= map.box().max.x; ++x) {
      if (const Chunk* chunk = map.find({x, y})) known += cells_known(*chunk);
    }
  }
  return known;
}

void replay_whole(benchmark::State& state, const ScanSource& source, double cell_size_m) {
  SlamConfig config;
  config.cell_size_m = cell_size_m;
  config.close_loops = false;  // cells are compared with what scans touched
  MappingResult result;
  for (auto _ : state) {
    const auto recording = open_source(source);
    result = replay(*recording, config, [](double, std::uint64_t) {});
  }
  const auto known = static_cast<double>(cells_known(result.map));
  const auto bytes = static_cast<double>(result.map_bytes);
  state.counters["scans/s"] = benchmark::Counter(static_cast<double>(result.trajectory.size()),
                                                 benchmark::Counter::kIsIterationInvariantRate);
  state.counters["chunks"] = static_cast<double>(result.map.chunk_count());
  state.counters["map_bytes"] = bytes;
  state.counters["cells_known"] = known;
  state.counters["bytes/2/cell"] = bytes / (2 * known);
  for (const auto& [stage, ms] : result.stages_ms) state.counters[stage + "_wall_s"] = 1e-3 * ms;
}

void read_only(benchmark::State& state, const ScanSource& source) {
  std::size_t scans = 0;
  for (auto _ : state) {
    scans = 0;
    const auto recording = open_source(source);
    while (const auto record = recording->next()) scans += std::holds_alternative<Scan>(*record) ? 1 : 0;
  }
  state.counters["scans/s"] =
      benchmark::Counter(static_cast<double>(scans), benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

void register_replay_benchmarks() {
  for_each_case("replay", [](const std::string& name, const ScanSource& source, double cell) {
    benchmark::RegisterBenchmark(name.c_str(), replay_whole, source, cell)->Unit(benchmark::kMillisecond);
  });
  for (const ScanSource& source : scan_sources()) {
    if (source.path.empty()) continue;  // lies in memory: there is nothing to read
    benchmark::RegisterBenchmark(("read/" + source.name).c_str(), read_only, source)
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace dynslam::bench
