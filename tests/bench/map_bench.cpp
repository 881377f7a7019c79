// SPDX-License-Identifier: MIT
// Work on a whole map of about a thousand chunks: snapshots, and the fill of its free space. Drawn from the
// real recording at 2 cm; cell size and beams make no difference here.
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/benchmarks.h"
#include "bench/scan_source.h"
#include "grid/flood_fill.h"

namespace dynslam::bench {
namespace {

constexpr double kCellSize_m = 0.02;
constexpr std::size_t kChunks = 1000;

struct BigMap {
  ChunkedGrid grid{kCellSize_m};
  std::vector<CellIndex> path;  ///< cells where the robot was
};

BigMap make_big_map() {
  BigMap map;
  const ScanSequence& sequence = sequence_of(real_source());
  for (std::size_t i = 0; i < sequence.scans.size() && map.grid.chunk_count() < kChunks; ++i) {
    draw(sequence, i, 1, map.grid);
    map.path.push_back(cell_at(sequence.map_T_robot[i].translation(), kCellSize_m));
  }
  return map;
}

/// Its cells change a little from one benchmark to the next; its chunks do not.
BigMap& big_map() {
  static BigMap map = make_big_map();
  return map;
}

/// A cell of each chunk.
std::vector<CellIndex> cell_of_each_chunk(const ChunkedGrid& grid) {
  std::vector<CellIndex> cells;
  for (std::int32_t y = grid.box().min.y; y <= grid.box().max.y; ++y) {
    for (std::int32_t x = grid.box().min.x; x <= grid.box().max.x; ++x) {
      if (grid.find({x, y})) cells.push_back(first_cell({x, y}));
    }
  }
  return cells;
}

void note_per_chunk(benchmark::State& state) {
  const auto chunks = static_cast<double>(big_map().grid.chunk_count());
  state.counters["chunks"] = chunks;
  state.counters["s/chunk"] =
      benchmark::Counter(chunks, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void snapshot(benchmark::State& state) {
  ChunkedGrid& grid = big_map().grid;
  for (auto _ : state) benchmark::DoNotOptimize(grid.snapshot().chunk_count());
  note_per_chunk(state);
}

/// One write to every chunk: with `after_snapshot` each is copied first, else it is the cost of the write
/// itself.
void write_each_chunk(benchmark::State& state, bool after_snapshot) {
  ChunkedGrid& grid = big_map().grid;
  const std::vector<CellIndex> cells = cell_of_each_chunk(grid);
  GridSnapshot held;
  for (auto _ : state) {
    state.PauseTiming();
    if (after_snapshot) held = grid.snapshot();
    state.ResumeTiming();
    for (const CellIndex c : cells) grid.add_miss(c);
  }
  note_per_chunk(state);
}

void free_cells(benchmark::State& state) {
  const GridSnapshot map = big_map().grid.snapshot();
  for (auto _ : state) benchmark::DoNotOptimize(cells_in_state(map, CellState::kFree).rows());
  note_per_chunk(state);
}

void fill(benchmark::State& state) {
  const GridSnapshot map = big_map().grid.snapshot();
  const CellBitmap free = cells_in_state(map, CellState::kFree);
  std::size_t reached = 0;
  for (auto _ : state) {
    const CellBitmap cells = flood_fill(free, big_map().path);
    benchmark::DoNotOptimize(cells.rows());
    state.PauseTiming();
    reached = cells.count();
    state.ResumeTiming();
  }
  note_per_chunk(state);
  state.counters["cells"] = static_cast<double>(reached);
  state.counters["cells/s"] =
      benchmark::Counter(static_cast<double>(reached), benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

void register_map_benchmarks() {
  benchmark::RegisterBenchmark("snapshot/csail_361_real/2cm", snapshot)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("write_after_snapshot/csail_361_real/2cm", write_each_chunk, true)
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("write_again/csail_361_real/2cm", write_each_chunk, false)
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("free_cells/csail_361_real/2cm", free_cells)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("flood_fill/csail_361_real/2cm", fill)->Unit(benchmark::kMicrosecond);
}

}  // namespace dynslam::bench
