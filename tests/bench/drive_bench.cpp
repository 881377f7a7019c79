// SPDX-License-Identifier: MIT
// One tick of the control thread: the dead man's switch, Safety with the collision zone, the kinematics.
// Ticks come 50 times a second, scans of 1200 beams ten times. And one turn of the follower of routes, 20
// times a second.
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/benchmarks.h"
#include "drive/drawn_scan.h"
#include "drive/drive_control.h"
#include "drive/path_follower.h"

namespace dynslam::bench {
namespace {

using std::chrono::milliseconds;

/// Furniture all around, much of it near: the dearest case, as far points are left out at once.
DrawnWorld crowded_room() {
  DrawnWorld world{{{-2, -1.5, 3, -1.5}, {3, -1.5, 3, 1.5}, {3, 1.5, -2, 1.5}, {-2, 1.5, -2, -1.5}}, {}};
  for (int i = 0; i < 12; ++i)
    world.posts.push_back({0.9 * std::cos(0.5 * i) + 0.3, 0.9 * std::sin(0.5 * i), 0.1});
  return world;
}

/// A driver who pushes ahead and turns.
void control_tick(benchmark::State& state, const DrawnWorld& world) {
  std::mt19937 random(1);
  const Scan drawn = scan_of(world);
  std::vector<std::shared_ptr<const Scan>> scans;
  for (int i = 0; i < 16; ++i) scans.push_back(shaken(drawn, Time(), random));
  DriveControl control;
  DriveInputs in;
  Time now;
  std::uint64_t tick = 0;
  Motion motion = Motion::kGo;
  for (auto _ : state) {
    now += milliseconds(20);
    if (tick % 5 == 0) {
      auto scan = std::const_pointer_cast<Scan>(scans[tick / 5 % scans.size()]);
      scan->stamp = now;
      in.scan = scan;
    }
    const bool pushed = tick > 50;
    in.command = DriveCommand{++tick, pushed ? Twist{1.5, 0.8} : Twist{}, now};
    in.imu = ImuSample{now, Eigen::Quaterniond(Eigen::AngleAxisd(0.01 * static_cast<double>(tick % 7),
                                                                 Eigen::Vector3d::UnitZ()))};
    in.motors = {now, {12.4, false, false, true}};
    in.pins = {now, {}};
    DriveOutput out = control.step(now, in);
    motion = out.verdict.motion;
    benchmark::DoNotOptimize(out.power);
  }
  state.SetLabel(to_string(motion));
  state.counters["s/tick"] =
      benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// A route through the room, from a robot that is now here, now there: with everything free only the wanted
/// arc is looked at, among furniture all of them.
void follower_next(benchmark::State& state, const DrawnWorld& world) {
  PathFollower follower;
  const RecentMotion motion;
  follower.see(scan_of(world, Time(), 1500), motion);
  follower.follow({1, {{0, 0}, {1, 0.2}, {2, -0.4}, {2.5, 1}, {2, 1.2}}, {}, 0.5, true});
  Time now;
  int tick = 0;
  Following last = Following::kIdle;
  for (auto _ : state) {
    now += milliseconds(50);
    const double off = 0.01 * static_cast<double>(++tick % 7);
    FollowOutput out = follower.next({now, {0.1 + off, off, off}, {0.3, 0.1}}, motion);
    last = out.state;
    benchmark::DoNotOptimize(out.twist);
    if (tick % 32 == 0)
      follower.follow({static_cast<std::uint64_t>(tick), {{0, 0}, {1, 0.2}, {2, -0.4}}, {}, 0.5, true});
  }
  state.SetLabel(to_string(last));
}

}  // namespace

void register_drive_benchmarks() {
  benchmark::RegisterBenchmark("control_tick/crowded_1200_drawn", control_tick, crowded_room())
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("control_tick/hall_1200_drawn", control_tick, DrawnWorld{})
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("follower_next/crowded_1500_drawn", follower_next, crowded_room())
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("follower_next/wall_1500_drawn", follower_next,
                               DrawnWorld{{{-2, -1.5, 5, -1.5}, {-2, 1.5, 5, 1.5}}, {}})
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace dynslam::bench
