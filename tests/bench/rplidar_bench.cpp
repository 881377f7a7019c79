// SPDX-License-Identifier: MIT
// Decoding what an RPLIDAR sends, from bytes to whole turns: as an A3 does, 15 900 beams a second.
#include <algorithm>
#include <cmath>

#include <benchmark/benchmark.h>

#include "base/angles.h"
#include "bench/benchmarks.h"
#include "drivers/rplidar/packet_stream.h"
#include "drivers/rplidar/turn_builder.h"
#include "drivers/rplidar_encoder.h"

namespace dynslam::bench {
namespace {

using test::PacketBytes;

constexpr double kSample_us = 62.90234375, kTurnsPerS = 10.0;
constexpr double kStep_deg = 360.0 * kTurnsPerS * 96 * 1e-6 * kSample_us;  // from capsule to capsule

/// A second of ultra capsules from a room with corners.
std::vector<PacketBytes> second_of_ultra() {
  std::vector<PacketBytes> packets;
  std::vector<double> mm(97);
  for (int i = 0; i * 96 * kSample_us < 1e6; ++i) {
    const double start = std::fmod(i * kStep_deg, 360.0);
    for (std::size_t k = 0; k < mm.size(); ++k) {
      const double angle = radians(start + kStep_deg * static_cast<double>(k) / 96.0);
      mm[k] = 2500.0 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
    }
    packets.push_back(test::encode_ultra(start, i == 0, mm));
  }
  return packets;
}

void rplidar_decode(benchmark::State& state) {
  const std::vector<PacketBytes> packets = second_of_ultra();
  const Duration sample = from_seconds(1e-6 * kSample_us);
  rplidar::PacketStream stream({rplidar::find_form(rplidar::AnswerType::kUltra), sample, 256000, {}});
  rplidar::TurnBuilder builder{LidarMount{}};
  std::vector<rplidar::Sample> samples;
  Time now;
  std::uint64_t beams = 0, turns = 0;
  for (auto _ : state) {
    for (const PacketBytes& packet : packets) {
      now += sample * 96;
      samples.clear();
      stream.feed(packet, now, samples);
      beams += samples.size();
      for (const rplidar::Sample& s : samples) {
        auto scan = builder.add(s);
        turns += scan ? 1 : 0;
        benchmark::DoNotOptimize(scan);
      }
    }
  }
  // An iteration is a second of the lidar's life: the time it takes is the share of a core.
  state.SetLabel(std::to_string(turns / static_cast<std::uint64_t>(state.iterations())) + " turns");
  state.counters["beams/s"] = benchmark::Counter(static_cast<double>(beams), benchmark::Counter::kIsRate);
}

}  // namespace

void register_rplidar_benchmarks() {
  benchmark::RegisterBenchmark("rplidar_decode/a3_second", rplidar_decode)->Unit(benchmark::kMicrosecond);
}

}  // namespace dynslam::bench
