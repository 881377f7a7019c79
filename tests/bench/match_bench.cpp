// SPDX-License-Identifier: MIT
// Matching a scan against a local map of the 25 scans before it, and the kernel of the exhaustive search.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/benchmarks.h"
#include "bench/scan_source.h"
#include "slam/byte_search.h"
#include "slam/hit_window.h"
#include "slam/local_map.h"
#include "slam/scan_matcher.h"

namespace dynslam::bench {
namespace {

/// A scan to match, and what it is matched against.
struct MatchCase {
  ChunkedGrid map;
  std::vector<MatchPoint> points;
  Pose2 map_T_robot;  ///< as SLAM found it
  double usual_hit = 255.0;
};

/// How well the pose is known before the match.
struct Knowledge {
  const char* name;
  double xy_m, yaw_rad;
};
constexpr Knowledge kNarrow{"match_narrow", 0.02, 0.004};  // as from the IMU
constexpr Knowledge kWide{"match_wide", 0.12, 0.08};       // as from velocity alone

/// The hits of a scan as Slam hands them to the matcher.
std::vector<MatchPoint> points_of(const CorrectedScan& scan, double cell_size_m) {
  std::vector<MatchPoint> points;
  for (const RayEnd& e : scan.ends_lidar) {
    if (!e.hit) continue;
    const Vector2 p = scan.robot_T_lidar * Vector2(e.x_m, e.y_m) / cell_size_m;
    const double weight = std::min(1.0, scan.beam_step_rad * e.range_m / cell_size_m);
    points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(weight)});
  }
  return points;
}

std::vector<MatchCase> cases_of(const ScanSource& source, double cell_size_m) {
  const ScanSequence& sequence = sequence_of(source);
  std::vector<MatchCase> cases;
  for (const std::size_t begin : stretches_of(sequence)) {
    const std::size_t at = begin + kStretchScans - 1;
    MatchCase c{ChunkedGrid(cell_size_m, 16384, kLocalMapRule), points_of(sequence.scans[at], cell_size_m),
                sequence.map_T_robot[at]};
    draw(sequence, begin, kStretchScans - 1, c.map);
    c.usual_hit = ScanMatcher().match(c.map, c.points, {c.map_T_robot}).mean_hit;
    cases.push_back(std::move(c));
  }
  return cases;
}

/// Off the truth by a little less than one sigma each way.
MatchPrior prior_for(const MatchCase& c, std::size_t index, const Knowledge& known) {
  const double side = index % 2 ? 0.8 : -0.8, other = index % 4 < 2 ? 0.8 : -0.8;
  return {{c.map_T_robot.x + side * known.xy_m, c.map_T_robot.y + other * known.xy_m,
           c.map_T_robot.yaw - side * known.yaw_rad},
          known.xy_m,
          known.yaw_rad,
          c.usual_hit};
}

void match(benchmark::State& state, const ScanSource& source, double cell_size_m, const Knowledge& known) {
  const std::vector<MatchCase> cases = cases_of(source, cell_size_m);
  ScanMatcher matcher;
  std::size_t i = 0;
  double off_m = 0, points = 0;
  for (auto _ : state) {
    const std::size_t k = i++ % cases.size();
    const MatchCase& c = cases[k];
    const MatchResult result = matcher.match(c.map, c.points, prior_for(c, k, known));
    off_m += (result.map_T_robot.translation() - c.map_T_robot.translation()).norm();
    points += static_cast<double>(c.points.size());
  }
  state.counters["off_metres"] = benchmark::Counter(off_m, benchmark::Counter::kAvgIterations);
  state.counters["points"] = benchmark::Counter(points, benchmark::Counter::kAvgIterations);
  state.counters["s/scan"] =
      benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// The same as score_16_shifts, a byte at a time.
Scores16 score_16_shifts_one_by_one(const std::uint8_t* row, std::span<const std::int32_t> offsets) {
  Scores16 total{};
  for (std::size_t shift = 0; shift < total.size(); ++shift) {
    for (const std::int32_t offset : offsets) total[shift] += row[static_cast<std::size_t>(offset) + shift];
  }
  return total;
}

constexpr int kHalf = 5;  ///< rows up and down that the search looks at

/// A window of a real map, and where the points of a scan lie in it.
struct Kernel {
  HitWindow window;
  std::vector<std::int32_t> offsets;
};

Kernel kernel_of(const MatchCase& c) {
  const double cell = c.map.cell_size_m();
  const Pose2 at{c.map_T_robot.x / cell, c.map_T_robot.y / cell, c.map_T_robot.yaw};
  Kernel kernel;
  kernel.window.load(c.map, c.points, at, kHalf, 0.02F);
  const Vector2 first(kernel.window.first().x, kernel.window.first().y);
  for (const MatchPoint& p : c.points) {
    const Vector2 in_window = at * Vector2(p.x, p.y) - first;
    const int x = static_cast<int>(in_window.x()) - kHalf, y = static_cast<int>(in_window.y());
    if (!kernel.window.contains(x, y - kHalf) || !kernel.window.contains(x, y + kHalf)) continue;
    kernel.offsets.push_back(y * kernel.window.stride() + x);
  }
  return kernel;
}

using Scorer = Scores16 (*)(const std::uint8_t*, std::span<const std::int32_t>);

/// Each of `bytes/s` is a look at one cell for one shift.
void score(benchmark::State& state, const ScanSource& source, double cell_size_m, Scorer scorer) {
  const Kernel kernel = kernel_of(cases_of(source, cell_size_m).front());
  int dy = -kHalf;
  for (auto _ : state) {
    const std::uint8_t* row = kernel.window.data() + static_cast<std::ptrdiff_t>(dy) * kernel.window.stride();
    benchmark::DoNotOptimize(scorer(row, kernel.offsets));
    dy = dy == kHalf ? -kHalf : dy + 1;
  }
  const auto looks = 16.0 * static_cast<double>(kernel.offsets.size());
  state.counters["points"] = static_cast<double>(kernel.offsets.size());
  state.counters["looks/s"] = benchmark::Counter(looks, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

void register_match_benchmarks() {
  for (const Knowledge& known : {kNarrow, kWide}) {
    for_each_case(known.name, [&](const std::string& name, const ScanSource& source, double cell) {
      benchmark::RegisterBenchmark(name.c_str(), match, source, cell, known)->Unit(benchmark::kMicrosecond);
    });
  }
  for_each_case("score_16_shifts", [&](const std::string& name, const ScanSource& source, double cell) {
    benchmark::RegisterBenchmark(name.c_str(), score, source, cell, &score_16_shifts);
  });
  for_each_case("score_one_by_one", [&](const std::string& name, const ScanSource& source, double cell) {
    benchmark::RegisterBenchmark(name.c_str(), score, source, cell, &score_16_shifts_one_by_one);
  });
}

}  // namespace dynslam::bench
