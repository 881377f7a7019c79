// SPDX-License-Identifier: MIT
// A turn of exploring, all but the planner's: what the map's changes come to, the frontiers, where to go. On
// a drawn floor of 100 x 60 m at 2 cm, half of its rooms explored.
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <benchmark/benchmark.h>

#include "autopilot/exploration.h"
#include "autopilot/frontier_map.h"
#include "bench/benchmarks.h"
#include "grid/flood_fill.h"

namespace dynslam::bench {
namespace {

constexpr double kCellSize_m = 0.02;
constexpr ChunkBox kFloor{{0, 0}, {77, 46}};
constexpr int kRoom = 300, kWall = 5, kDoor = 50;  ///< cells
constexpr ChunkIndex kScanned{24, 20};             ///< of what a scan changes, the lowest
constexpr int kScannedChunks = 10, kNewChunks = 2;

bool is_explored(int room_x, int room_y) { return (7 * room_x + 3 * room_y) % 5 < 3; }

std::uint32_t noise(CellIndex c) {
  auto h = static_cast<std::uint32_t>(c.x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(c.y) * 0x85EBCA77U;
  h ^= h >> 15;
  return h * 0x2C1B3C6DU >> 12;
}

/// Rooms with a door in the middle of each wall and a cupboard with its shadow; missed cells here and there.
CellState drawn_state(CellIndex c) {
  const int x = c.x % kRoom, y = c.y % kRoom;
  if (!is_explored(c.x / kRoom, c.y / kRoom)) return CellState::kUnknown;
  const bool is_wall = x < kWall || y < kWall || x >= kRoom - kWall || y >= kRoom - kWall;
  const bool is_door = std::abs(x - kRoom / 2) < kDoor / 2 || std::abs(y - kRoom / 2) < kDoor / 2;
  if (is_wall && !is_door) return CellState::kOccupied;
  if (x > 60 && x < 100 && y > 200 && y < 203) return CellState::kOccupied;
  if (x > 60 && x < 100 && y >= 203 && y < 240) return CellState::kUnknown;
  return noise(c) % 500 == 0 ? CellState::kUnknown : CellState::kFree;
}

std::pair<CellTile, CellTile> drawn_tiles(ChunkIndex index) {
  std::pair<CellTile, CellTile> tiles{};
  const CellIndex first = first_cell(index);
  for (int r = 0; r < kChunkSide; ++r) {
    for (int b = 0; b < kChunkSide; ++b) {
      const CellState state = drawn_state({first.x + b, first.y + r});
      const std::uint64_t bit = std::uint64_t{1} << b;
      if (state == CellState::kFree) tiles.first[static_cast<std::size_t>(r)] |= bit;
      if (state == CellState::kOccupied) tiles.second[static_cast<std::size_t>(r)] |= bit;
    }
  }
  return tiles;
}

template <class Visit>
void for_each_chunk(const ChunkBox& box, Visit&& visit) {
  for (std::int32_t y = box.min.y; y <= box.max.y; ++y) {
    for (std::int32_t x = box.min.x; x <= box.max.x; ++x) visit(ChunkIndex{x, y});
  }
}

/// The floor; its cells change from one benchmark to the next, and back.
ChunkedGrid& floor_grid() {
  static ChunkedGrid grid = [] {
    ChunkedGrid drawn(kCellSize_m);
    for_each_chunk(kFloor, [&](ChunkIndex c) {
      const auto [free, occupied] = drawn_tiles(c);
      drawn.show(c, free, occupied);
    });
    return drawn;
  }();
  return grid;
}

/// What a scan does: bytes change all around, and some cells become known, or unknown again.
void change(ChunkedGrid& grid, bool is_new_known) {
  const ChunkIndex high{kScanned.x + kScannedChunks - 1, kScanned.y + kScannedChunks - 1};
  for_each_chunk({kScanned, high}, [&](ChunkIndex c) {
    auto [free, occupied] = drawn_tiles(c);
    if (is_new_known && c.x < kScanned.x + kNewChunks && c.y < kScanned.y + kNewChunks) free.fill(~0ULL);
    grid.show(c, free, occupied);
  });
}

/// A planner that finds everything that is free.
struct FreeSpaceReach {
  CellBitmap free = cells_in_state(floor_grid().snapshot(), CellState::kFree);
  Vector2 robot{37.0, 31.0};

  Reachability reach() const {
    return {[this](const Vector2& p) -> std::optional<double> {
              if (!free.test(cell_at(p, kCellSize_m))) return std::nullopt;
              return 1.3 * (p - robot).norm();
            },
            [](const Vector2& p, double) { return std::optional(p); }};
  }
};

void update_all(benchmark::State& state) {
  const GridSnapshot map = floor_grid().snapshot();
  std::size_t redone = 0;
  for (auto _ : state) {
    FrontierMap frontiers;
    redone = frontiers.update({}, map);
  }
  state.counters["redone"] = static_cast<double>(redone);
}

void update_after_scan(benchmark::State& state) {
  ChunkedGrid& grid = floor_grid();
  FrontierMap frontiers;
  frontiers.update({}, grid.snapshot());
  std::size_t redone = 0;
  bool is_new_known = false;
  for (auto _ : state) {
    state.PauseTiming();
    change(grid, is_new_known = !is_new_known);
    const GridSnapshot map = grid.snapshot();
    state.ResumeTiming();
    redone = frontiers.update({}, map);
  }
  change(grid, false);
  state.counters["redone"] = static_cast<double>(redone);
}

void find_all_frontiers(benchmark::State& state) {
  FrontierMap map;
  map.update({}, floor_grid().snapshot());
  std::size_t found = 0;
  for (auto _ : state) found = map.frontiers().size();
  state.counters["cells"] = static_cast<double>(map.cells().size());
  state.counters["frontiers"] = static_cast<double>(found);
}

void choose_frontier(benchmark::State& state) {
  const GridSnapshot map = floor_grid().snapshot();
  FrontierMap cells;
  cells.update({}, map);
  const auto frontiers = cells.frontiers();
  const FreeSpaceReach planner;
  const Reachability reach = planner.reach();
  Exploration exploration;
  for (auto _ : state)
    benchmark::DoNotOptimize(exploration.places(Time(), planner.robot, frontiers, VisitMap(), map, reach));
}

/// The dearest: all was visited that can be reached, and all of it has to be asked for.
void choose_cell(benchmark::State& state, bool is_visited) {
  const GridSnapshot map = floor_grid().snapshot();
  const FreeSpaceReach planner;
  const Reachability reach = planner.reach();
  VisitMap visits;
  for (int i = 0; is_visited && i < 200 * 120; ++i)
    visits.note(Time(), cell_centre({i % 200, i / 200}, kHistoryCell_m));
  Exploration exploration;
  const Time now = time_at_s(3600);
  std::size_t found = 0;
  for (auto _ : state) found = exploration.places(now, planner.robot, {}, visits, map, reach).size();
  state.counters["places"] = static_cast<double>(found);
}

}  // namespace

void register_autopilot_benchmarks() {
  constexpr auto kUnit = benchmark::kMicrosecond;
  benchmark::RegisterBenchmark("frontier_update/whole_floor/2cm", update_all)->Unit(kUnit);
  benchmark::RegisterBenchmark("frontier_update/after_scan/2cm", update_after_scan)->Unit(kUnit);
  benchmark::RegisterBenchmark("frontiers/floor/2cm", find_all_frontiers)->Unit(kUnit);
  benchmark::RegisterBenchmark("explore/frontiers/2cm", choose_frontier)->Unit(kUnit);
  benchmark::RegisterBenchmark("explore/unvisited/2cm", choose_cell, false)->Unit(kUnit);
  benchmark::RegisterBenchmark("explore/old/2cm", choose_cell, true)->Unit(kUnit);
}

}  // namespace dynslam::bench
