// SPDX-License-Identifier: MIT
// Planning: keeping the costmap up to date, and finding ways. Two drawn buildings of 2 cm cells: a flat of 12
// x 9 m, and a hall of 100 x 60 m with shelves, both wholly known.
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/benchmarks.h"
#include "plan/costmap.h"
#include "plan/path_planner.h"

namespace dynslam::bench {
namespace {

constexpr double kCellSize_m = 0.02;
constexpr double kRobotRadius_m = 0.19;

struct Box {
  double left, low, right, high;
};

/// A floor of free cells with boxes and gaps in them, in this order.
struct Building {
  double width_m, depth_m;
  std::vector<Box> boxes, doors;
};

Building flat() {
  return {12,
          9,
          {{5, 0, 5.1, 9},
           {5.1, 4.5, 12, 4.6},
           {8.5, 0, 8.6, 4.5},
           {1, 1, 2.5, 2},
           {3.2, 6.5, 4.2, 8},
           {6.5, 6, 8.5, 7},
           {10, 1.5, 10.8, 2.2}},
          {{5, 1.5, 5.1, 2.3}, {5, 6.5, 5.1, 7.3}, {9.5, 4.5, 10.3, 4.6}, {8.5, 2.5, 8.6, 3.3}}};
}

/// Shelves 1 m deep with aisles of 2 m, broken by two cross aisles; pallets here and there.
Building hall() {
  Building hall{100, 60, {}, {}};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(1, 98), y(1, 58);
  for (int row = 0; row < 18; ++row) {
    for (const double left : {5.0, 36.0, 67.0})
      hall.boxes.push_back({left, 3.0 * row + 4, left + 28, 3.0 * row + 5});
  }
  for (int i = 0; i < 60; ++i) {
    const double left = x(random), low = y(random);
    hall.boxes.push_back({left, low, left + 0.8, low + 1.2});
  }
  return hall;
}

void fill(CellBitmap& cells, const Box& box, bool value) {
  for (int y = static_cast<int>(box.low / kCellSize_m); y < static_cast<int>(box.high / kCellSize_m); ++y) {
    for (int x = static_cast<int>(box.left / kCellSize_m); x < static_cast<int>(box.right / kCellSize_m); ++x)
      value ? cells.set({x, y}) : cells.clear({x, y});
  }
}

std::unique_ptr<ChunkedGrid> grid_of(const Building& building) {
  const auto chunks = [](double m) { return static_cast<int>(m / kCellSize_m) / kChunkSide; };
  CellBitmap free, occupied;
  const ChunkBox box{{0, 0}, {chunks(building.width_m), chunks(building.depth_m)}};
  free.reset(box);
  occupied.reset(box);
  const double w = building.width_m, d = building.depth_m;
  fill(free, {0, 0, w, d}, true);
  fill(occupied, {0, 0, w, 0.1}, true);
  fill(occupied, {0, d - 0.1, w, d}, true);
  fill(occupied, {0, 0, 0.1, d}, true);
  fill(occupied, {w - 0.1, 0, w, d}, true);
  for (const Box& b : building.boxes) fill(occupied, b, true);
  for (const Box& b : building.doors) fill(occupied, b, false);
  auto grid = std::make_unique<ChunkedGrid>(kCellSize_m);
  for (int y = 0; y <= box.max.y; ++y) {
    for (int x = 0; x <= box.max.x; ++x) {
      CellTile open = free.tile({x, y});
      const CellTile full = occupied.tile({x, y});
      for (std::size_t r = 0; r < open.size(); ++r) open[r] &= ~full[r];
      grid->show({x, y}, open, full);
    }
  }
  return grid;
}

void first_build(benchmark::State& state, const Building& building) {
  const auto grid = grid_of(building);
  const GridSnapshot map = grid->snapshot();
  std::size_t computed = 0;
  for (auto _ : state) computed = Costmap(kCellSize_m).update(map);
  state.counters["chunks"] = static_cast<double>(computed);
}

/// What a scan does to a map: bytes change in 60 chunks, and something comes and goes in one place.
void local_change(benchmark::State& state, const Building& building) {
  const auto grid = grid_of(building);
  Costmap costmap(kCellSize_m);
  costmap.update(grid->snapshot());
  bool there = false;
  std::size_t computed = 0;
  for (auto _ : state) {
    state.PauseTiming();
    for (int i = 0; i < 60; ++i) grid->add_miss({3 + kChunkSide * (i % 9), 3 + kChunkSide * (i / 9)});
    there = !there;
    for (int look = 0; look < 30; ++look) there ? grid->add_hit({200, 250}) : grid->add_miss({200, 250});
    const GridSnapshot map = grid->snapshot();
    state.ResumeTiming();
    computed = costmap.update(map);
  }
  state.counters["chunks"] = static_cast<double>(computed);
}

/// From anywhere to anywhere.
void plan(benchmark::State& state, const Building& building, bool reach) {
  const auto grid = grid_of(building);
  Costmap costmap(kCellSize_m);
  costmap.update(grid->snapshot());
  PathPlanner planner({}, kRobotRadius_m);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> x(0, building.width_m), y(0, building.depth_m);
  const auto anywhere = [&] {
    while (true) {
      const Vector2 at{x(random), y(random)};
      if (costmap.clearance_m(at) > 0.3) return at;
    }
  };
  double length_m = 0, found = 0;
  for (auto _ : state) {
    const Vector2 start = anywhere(), goal = anywhere();
    if (reach) {
      benchmark::DoNotOptimize(planner.reach(costmap, start).length_m(goal));
      continue;
    }
    const Plan plan = planner.plan(costmap, {start, goal});
    length_m += plan.length_m;
    found += plan.outcome == PlanOutcome::kFound;
  }
  if (reach) return;
  state.counters["m"] = benchmark::Counter(length_m, benchmark::Counter::kAvgIterations);
  state.counters["found"] = benchmark::Counter(found, benchmark::Counter::kAvgIterations);
}

}  // namespace

void register_plan_benchmarks() {
  const auto in = [](const char* what, const char* where) { return std::string(what) + where + "/2cm"; };
  for (const auto& [name, building] :
       {std::pair{"/flat_12x9_drawn", flat()}, {"/hall_100x60_drawn", hall()}}) {
    benchmark::RegisterBenchmark(in("costmap_build", name).c_str(), first_build, building)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(in("costmap_update", name).c_str(), local_change, building)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(200);
    benchmark::RegisterBenchmark(in("plan", name).c_str(), plan, building, false)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(in("reach", name).c_str(), plan, building, true)
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace dynslam::bench
