// SPDX-License-Identifier: MIT
// What a finished local map costs the back end: clean-up, loop search, solving, drawing; and how that grows
// with the maps there are. On the local maps of the real recording at 2 cm, a building of some 40 x 60 m; for
// more maps than it has, copies of the building are set side by side.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/benchmarks.h"
#include "bench/scan_source.h"
#include "slam/clean_up.h"
#include "slam/front_end.h"
#include "slam/global_map.h"
#include "slam/loop_closer.h"
#include "slam/pose_graph.h"

namespace dynslam::bench {
namespace {

using MapPtr = std::shared_ptr<const FinishedMap>;
constexpr int kMostMaps = 500;
constexpr std::uint32_t kSeen = 20;
constexpr double kBuilding_m = 100.0;  ///< from one copy of the building to the next

struct Building {
  std::vector<LocalMap> local;
  std::vector<MapPtr> finished;
};

Building make_building() {
  Building building;
  SlamConfig config;
  config.trusted_range_m = 30.0;
  FrontEnd front_end(config);
  const auto recording = open_source(real_source());
  while (auto record = recording->next()) {
    std::visit([&](auto&& sample) { front_end.add(std::forward<decltype(sample)>(sample)); },
               std::move(*record));
    while (front_end.next()) {
    }
    while (auto complete = front_end.take_complete()) building.local.push_back(std::move(*complete));
  }
  for (const LocalMap& map : building.local)
    building.finished.push_back(std::make_shared<const FinishedMap>(clean_up(map, map.id, map.ended)));
  return building;
}

const Building& building() {
  static const Building made = make_building();
  return made;
}

/// The n-th map: of the building, or of a copy of it.
MapPtr map_of(std::size_t n, std::size_t id) {
  const auto& maps = building().finished;
  auto copy = std::make_shared<FinishedMap>(*maps[n % maps.size()]);
  copy->id = static_cast<std::uint32_t>(id);
  return copy;
}
MapPtr map_of(std::size_t n) { return map_of(n, n); }

Pose2 pose_of(std::size_t n) {
  const std::size_t in_building = building().finished.size();
  const Pose2& origin = building().finished[n % in_building]->drawn_T_origin;
  return {origin.x + kBuilding_m * static_cast<double>(n / in_building), origin.y, origin.yaw};
}

Eigen::Matrix3d odometry_covariance() { return Eigen::Vector3d(4e-4, 4e-4, 2e-5).asDiagonal(); }

/// A chain of n maps with odometry between them.
PoseGraph chain(std::size_t n) {
  PoseGraph graph;
  const Eigen::Matrix3d covariance = odometry_covariance();
  for (std::size_t i = 0; i < n; ++i) {
    const auto id = static_cast<std::uint32_t>(i);
    graph.add_node(id, pose_of(i));
    if (i > 0) graph.add_odometry_edge(id - 1, id, pose_of(i - 1).inverse() * pose_of(i), covariance);
  }
  return graph;
}

void cleaning(benchmark::State& state) {
  const std::vector<LocalMap>& maps = building().local;
  std::size_t i = 0;
  for (auto _ : state) {
    const LocalMap& map = maps[i++ % maps.size()];
    benchmark::DoNotOptimize(clean_up(map, map.id, map.ended));
  }
}

/// All that a new map is searched for among n, the same for all n: it is the 21st once more, come to from
/// the one before that.
void searching(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    state.PauseTiming();
    PoseGraph graph = chain(n - 1);
    LoopCloser loops(graph);
    for (std::size_t i = 0; i + 1 < n; ++i) loops.know(map_of(i));
    const MapPtr newest = map_of(kSeen, n - 1);
    graph.add_node(newest->id, pose_of(kSeen));
    graph.add_odometry_edge(kSeen - 1, newest->id, pose_of(kSeen - 1).inverse() * pose_of(kSeen),
                            odometry_covariance());
    state.ResumeTiming();
    benchmark::DoNotOptimize(loops.close(newest));
  }
  state.counters["maps"] = static_cast<double>(n);
}

/// A loop from the map ten before, or the first, to the i-th, a little off.
void add_loop(PoseGraph& graph, std::size_t i) {
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  const Pose2 off{0.02 * std::sin(static_cast<double>(i)), 0.02, 0.002};
  const std::size_t from = i - std::min<std::size_t>(i, 10);
  graph.add_loop_edge(static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(i),
                      pose_of(from).inverse() * pose_of(i) * off, covariance);
}

/// A graph of n maps with a loop for each: all of them new, which bends it the more the longer it is, or
/// only that of the newest, as when a map is finished.
void solve_loops(benchmark::State& state, bool all_new) {
  const auto n = static_cast<std::size_t>(state.range(0));
  PoseGraph before = chain(n);
  for (std::size_t i = 2; i + 1 < n; ++i) add_loop(before, i);
  if (!all_new) before.solve();
  add_loop(before, n - 1);
  int iterations = 0;
  for (auto _ : state) {
    state.PauseTiming();
    PoseGraph graph = before;
    state.ResumeTiming();
    const PoseGraphSummary summary = graph.solve();
    iterations = summary.iterations;
    benchmark::DoNotOptimize(graph);
  }
  state.counters["maps"] = static_cast<double>(n);
  state.counters["iterations"] = iterations;
}
void solving(benchmark::State& state) { solve_loops(state, false); }
void solving_all(benchmark::State& state) { solve_loops(state, true); }

/// Everything of n maps drawn anew, as after a correction that moves all.
void drawing(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  GlobalMap map(0.02);
  for (std::size_t i = 0; i < n; ++i) map.place(map_of(i), pose_of(i));
  while (map.redraw(100000) > 0) continue;
  double shift = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    shift = shift > 0 ? 0.0 : 0.03;
    std::map<std::uint32_t, Pose2> moved;
    for (std::size_t i = 0; i < n; ++i)
      moved[static_cast<std::uint32_t>(i)] = Pose2{shift, 0, 0} * pose_of(i);
    state.ResumeTiming();
    map.move(moved);
    while (map.redraw(100000) > 0) continue;
    benchmark::DoNotOptimize(map.publish());
  }
  state.counters["maps"] = static_cast<double>(n);
  state.counters["blocks"] = static_cast<double>(map.blocks());
}

}  // namespace

void register_back_end_benchmarks() {
  benchmark::RegisterBenchmark("clean_up", cleaning)->Unit(benchmark::kMillisecond);
  const std::pair<const char*, void (*)(benchmark::State&)> growing[] = {
      {"loop_search", searching}, {"solve", solving}, {"solve_all_new", solving_all}, {"redraw", drawing}};
  for (const auto& [name, run] : growing) {
    benchmark::RegisterBenchmark(name, run)
        ->RangeMultiplier(2)
        ->Range(32, kMostMaps)
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace dynslam::bench
