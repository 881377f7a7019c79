// SPDX-License-Identifier: MIT
// How fast the machine moves bytes at all, as a measure for how fast the map's bytes are moved. Bytes are
// counted once for the read and once for the write.
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/benchmarks.h"
#include "grid/cell_rules.h"

namespace dynslam::bench {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Far beyond the caches of any machine the robot or its developers have.
constexpr std::size_t kLarge = std::size_t{64} << 20;

/// Half of the second-level cache, so that what is measured surely lies in it.
std::size_t half_of_l2() {
  constexpr std::size_t kSmallest = std::size_t{256} << 10;
  for (const auto& cache : benchmark::CPUInfo::Get().caches) {
    if (cache.level == 2 && cache.size > 0) return static_cast<std::size_t>(cache.size) / 2;
  }
  return kSmallest / 2;
}

void note_traffic(benchmark::State& state, std::size_t bytes) {
  state.counters["bytes/s"] =
      benchmark::Counter(2.0 * static_cast<double>(bytes), benchmark::Counter::kIsIterationInvariantRate);
}

void copy(benchmark::State& state, std::size_t bytes) {
  const Bytes from(bytes, 1);
  Bytes to(bytes, 2);
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), bytes);
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  note_traffic(state, bytes);
}

/// What clearing does to a plane of the map, without the map.
void add(benchmark::State& state, std::size_t bytes) {
  Bytes plane(bytes, 1);
  for (auto _ : state) {
    for (std::uint8_t& cell : plane) cell = raised(cell, 26);
    benchmark::DoNotOptimize(plane.data());
    benchmark::ClobberMemory();
  }
  note_traffic(state, bytes);
}

}  // namespace

void register_memory_benchmarks() {
  const std::size_t small = half_of_l2();
  benchmark::RegisterBenchmark("bandwidth_copy/memory", copy, kLarge)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("bandwidth_add/memory", add, kLarge)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("bandwidth_copy/L2", copy, small / 2)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("bandwidth_add/L2", add, small)->Unit(benchmark::kMicrosecond);
}

}  // namespace dynslam::bench
