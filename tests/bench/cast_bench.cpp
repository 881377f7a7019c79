// SPDX-License-Identifier: MIT
// The simulator: casting a turn of the lidar in its worlds, by buckets and face by face, with people and
// doors sorted in anew; a second of simulated life; a picture of the camera.
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/benchmarks.h"
#include "sim/actors.h"
#include "sim/camera_picture.h"
#include "sim/life.h"
#include "sim/ray_caster.h"

namespace dynslam::bench {
namespace {

constexpr int kBeams = 1200;

/// Calls `cast(ray)` for each beam of a turn from the n-th point of the world's tour.
template <class Cast>
void cast_turn(const World& world, std::size_t n, Cast&& cast) {
  SpaceRay ray;
  ray.from = world.tour[n % world.tour.size()];
  ray.height_m = 0.18;
  for (int i = 0; i < kBeams; ++i) {
    ray.direction = unit(kTwoPi * i / kBeams);
    cast(ray);
  }
}

void note_turns(benchmark::State& state) {
  state.counters["s/scan"] =
      benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void cast_fast(benchmark::State& state, const std::string& name) {
  const World world = load_world(name);
  const Actors actors(world);
  RayCaster caster(fixed_surfaces(world), Actors::reach(world));
  std::size_t n = 0;
  for (auto _ : state) {
    caster.set_moving(actors.surfaces());
    cast_turn(world, n++, [&](const SpaceRay& ray) { benchmark::DoNotOptimize(caster.cast(ray)); });
  }
  note_turns(state);
}

void cast_plainly(benchmark::State& state, const std::string& name) {
  const World world = load_world(name);
  std::vector<Surface> faces = fixed_surfaces(world);
  for (const Surface& face : Actors(world).surfaces()) faces.push_back(face);
  RayCaster caster({}, Actors::reach(world));  // each face once, not once a bucket
  caster.set_moving(faces);
  std::size_t n = 0;
  for (auto _ : state) {
    cast_turn(world, n++,
              [&](const SpaceRay& ray) { benchmark::DoNotOptimize(caster.cast_by_brute_force(ray)); });
  }
  note_turns(state);
}

void live_a_second(benchmark::State& state, const std::string& name) {
  Life life(load_world(name), Time(), 1);
  for (auto _ : state) {
    for (Time end = life.now() + std::chrono::seconds(1); life.now() < end; life.step()) {
    }
  }
}

void draw_picture(benchmark::State& state, const std::string& name) {
  const World world = load_world(name);
  CameraPicture picture(world);
  CameraView view;
  view.pose.world_T_robot = world.world_T_start;
  view.moving = Actors(world).surfaces();
  for (auto _ : state) benchmark::DoNotOptimize(encode_jpeg(picture.draw(view)).size());
}

}  // namespace

void register_cast_benchmarks() {
  for (const std::string name : {"apartment", "office", "warehouse"}) {
    const auto add = [&](const char* what, auto&& run, benchmark::TimeUnit unit) {
      benchmark::RegisterBenchmark((what + ("/" + name)).c_str(), run, name)->Unit(unit);
    };
    add("cast_fast", cast_fast, benchmark::kMicrosecond);
    add("cast_plainly", cast_plainly, benchmark::kMicrosecond);
    add("live_a_second", live_a_second, benchmark::kMillisecond);
    add("draw_picture", draw_picture, benchmark::kMillisecond);
  }
}

}  // namespace dynslam::bench
