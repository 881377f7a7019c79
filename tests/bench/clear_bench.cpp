// SPDX-License-Identifier: MIT
// Drawing scans into a map: ray by ray, the reference, and as spans. An iteration draws a few stretches of
// the recording, each into a map of its own that begins with the stretch's first scan: chunks are allotted
// before the clock runs, and no cell has been looked at so often yet that there is nothing left to write.
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/benchmarks.h"
#include "bench/scan_source.h"
#include "grid/free_space.h"
#include "grid/ray_walk.h"
#include "slam/local_map.h"

namespace dynslam::bench {
namespace {

constexpr std::size_t kMaxChunks = 16384;

/// A scan where it was taken.
struct Placed {
  const CorrectedScan& scan;
  Pose2 map_T_lidar;
};

Placed placed(const ScanSequence& sequence, std::size_t i) {
  return {sequence.scans[i], sequence.map_T_robot[i] * sequence.scans[i].robot_T_lidar};
}

/// Draws each ray by itself, cells near the robot once for each ray. Returns the cells touched.
std::size_t draw_by_rays(const Placed& p, ChunkedGrid& grid) {
  std::size_t cells = 0;
  const Vector2 from = p.map_T_lidar.translation();
  for (const RayEnd& e : p.scan.ends_lidar) {
    const Vector2 to = p.map_T_lidar * Vector2(e.x_m, e.y_m);
    const CellIndex last = cell_at(to, grid.cell_size_m());
    walk_ray(from, to, grid.cell_size_m(), [&](CellIndex c) {
      ++cells;
      if (e.hit && c == last) {
        grid.add_hit(c);
      } else {
        grid.add_miss(c);
      }
    });
  }
  return cells;
}

const ScanFootprint& trace(const Placed& p, double cell_size_m, FreeSpace& free_space) {
  return free_space.trace(p.map_T_lidar, p.scan.ends_lidar, max_wedge_rad(p.scan), cell_size_m);
}

/// A miss or a hit reads both bytes of a cell and writes both.
void note_cells(benchmark::State& state, std::size_t scans, std::size_t cells) {
  using benchmark::Counter;
  const auto rate = Counter::kIsIterationInvariantRate;
  state.counters["s/scan"] = Counter(static_cast<double>(scans), rate | Counter::kInvert);
  state.counters["cells/scan"] = Counter(static_cast<double>(cells) / static_cast<double>(scans));
  state.counters["cells/s"] = Counter(static_cast<double>(cells), rate);
  state.counters["bytes/s"] = Counter(4.0 * static_cast<double>(cells), rate);
}

std::size_t cells_of(const ScanSequence& sequence, const std::vector<std::size_t>& begins,
                     double cell_size_m) {
  FreeSpace free_space;
  std::size_t cells = 0;
  for (const std::size_t begin : begins) {
    for (std::size_t i = begin + 1; i < begin + kStretchScans; ++i) {
      const ScanFootprint& footprint = trace(placed(sequence, i), cell_size_m, free_space);
      cells += footprint.misses.count() + footprint.hits.size();
    }
  }
  return cells;
}

/// Draws all but the first scan of each stretch by `draw_one(placed, grid)` and measures that.
template <class DrawOne>
void draw_stretches(benchmark::State& state, const ScanSequence& sequence, double cell_size_m,
                    std::size_t looks_before, DrawOne&& draw_one) {
  const std::vector<std::size_t> begins = stretches_of(sequence);
  for (auto _ : state) {
    for (const std::size_t begin : begins) {
      state.PauseTiming();
      ChunkedGrid grid(cell_size_m, kMaxChunks, kLocalMapRule);
      if (looks_before == 0) draw(sequence, begin, 1, grid);
      for (std::size_t k = 0; k < looks_before; ++k) draw(sequence, begin, kStretchScans, grid);
      state.ResumeTiming();
      for (std::size_t i = begin + 1; i < begin + kStretchScans; ++i) draw_one(placed(sequence, i), grid);
      benchmark::DoNotOptimize(grid.chunk_count());
    }
  }
}

std::size_t scans_of(const ScanSequence& sequence) {
  return stretches_of(sequence).size() * (kStretchScans - 1);
}

void clear_rays(benchmark::State& state, const ScanSource& source, double cell_size_m) {
  const ScanSequence& sequence = sequence_of(source);
  std::size_t cells = 0;
  draw_stretches(state, sequence, cell_size_m, 0,
                 [&](const Placed& p, ChunkedGrid& grid) { cells += draw_by_rays(p, grid); });
  note_cells(state, scans_of(sequence), cells / static_cast<std::size_t>(state.iterations()));
}

/// `looks_before`: how often the stretch was drawn before. After many a robot stands in a map that is sure of
/// itself.
void clear_spans(benchmark::State& state, const ScanSource& source, double cell_size_m,
                 std::size_t looks_before) {
  const ScanSequence& sequence = sequence_of(source);
  FreeSpace free_space;
  draw_stretches(state, sequence, cell_size_m, looks_before,
                 [&](const Placed& p, ChunkedGrid& grid) { grid.apply(trace(p, cell_size_m, free_space)); });
  note_cells(state, scans_of(sequence), cells_of(sequence, stretches_of(sequence), cell_size_m));
}

/// The part of clear_spans that writes the map: the footprints are there before the clock runs.
void apply_alone(benchmark::State& state, const ScanSource& source, double cell_size_m) {
  const ScanSequence& sequence = sequence_of(source);
  const std::vector<std::size_t> begins = stretches_of(sequence);
  FreeSpace free_space;
  std::vector<ScanFootprint> footprints(kStretchScans - 1);
  for (auto _ : state) {
    for (const std::size_t begin : begins) {
      state.PauseTiming();
      ChunkedGrid grid(cell_size_m, kMaxChunks, kLocalMapRule);
      draw(sequence, begin, 1, grid);
      for (std::size_t i = 0; i < footprints.size(); ++i) {
        footprints[i] = trace(placed(sequence, begin + 1 + i), cell_size_m, free_space);
      }
      state.ResumeTiming();
      for (const ScanFootprint& footprint : footprints) grid.apply(footprint);
      benchmark::DoNotOptimize(grid.chunk_count());
    }
  }
  note_cells(state, scans_of(sequence), cells_of(sequence, begins, cell_size_m));
}

/// The part of clear_spans that does not touch the map.
void trace_alone(benchmark::State& state, const ScanSource& source, double cell_size_m) {
  const ScanSequence& sequence = sequence_of(source);
  const std::vector<std::size_t> begins = stretches_of(sequence);
  FreeSpace free_space;
  for (auto _ : state) {
    for (const std::size_t begin : begins) {
      for (std::size_t i = begin + 1; i < begin + kStretchScans; ++i) {
        benchmark::DoNotOptimize(&trace(placed(sequence, i), cell_size_m, free_space));
      }
    }
  }
  state.counters["s/scan"] =
      benchmark::Counter(static_cast<double>(scans_of(sequence)),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace

void register_clear_benchmarks() {
  constexpr std::size_t kMany = 5;  // times 26 looks
  const auto in_ms = [](auto* b) { b->Unit(benchmark::kMillisecond); };
  for_each_case("clear_rays", [&](const std::string& name, const ScanSource& source, double cell) {
    in_ms(benchmark::RegisterBenchmark(name.c_str(), clear_rays, source, cell));
  });
  for_each_case("clear_spans", [&](const std::string& name, const ScanSource& source, double cell) {
    in_ms(benchmark::RegisterBenchmark(name.c_str(), clear_spans, source, cell, std::size_t{0}));
  });
  for_each_case("clear_spans_sure", [&](const std::string& name, const ScanSource& source, double cell) {
    in_ms(benchmark::RegisterBenchmark(name.c_str(), clear_spans, source, cell, kMany));
  });
  for_each_case("apply_alone", [&](const std::string& name, const ScanSource& source, double cell) {
    in_ms(benchmark::RegisterBenchmark(name.c_str(), apply_alone, source, cell));
  });
  for_each_case("trace_alone", [&](const std::string& name, const ScanSource& source, double cell) {
    in_ms(benchmark::RegisterBenchmark(name.c_str(), trace_alone, source, cell));
  });
}

}  // namespace dynslam::bench
