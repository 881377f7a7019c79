// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "pipe/clock.h"
#include "sim/furniture.h"
#include "sim/simulator.h"

namespace dynslam {

/// A room of 8 x 6 m with its corner in the origin, the robot 2 m from the west wall, facing east.
inline World bare_room() {
  World world;
  world.name = "bare room";
  world.walls.push_back({{{0, 0}, {8, 0}, {8, 6}, {0, 6}, {0, 0}}});
  world.world_T_start = {2.0, 3.0, 0.0};
  return world;
}

inline Furniture box_at(double x, double y, double size_m, double low_m, double high_m) {
  FurnitureForm form;
  form.shape = "box";
  form.size_m = Vector2(size_m, size_m);
  form.low_m = low_m;
  form.high_m = high_m;
  Furniture thing;
  thing.name = "box";
  thing.world_T_thing = {x, y, 0.0};
  thing.parts = furniture_parts(form);
  return thing;
}

/// A simulation under a stepped clock that begins at 100 s.
struct SteppedSim {
  explicit SteppedSim(World world, std::uint64_t seed = 1)
      : simulator(std::make_shared<Simulator>(std::move(world), clock, seed)),
        devices(make_devices(simulator)) {}

  void go_to(double s) { clock.set(begin + from_seconds(s)); }
  /// Repeats a power every 20 ms from one time to another.
  void drive(const WheelPower& power, double from_s, double to_s) {
    for (double s = from_s; s < to_s - 1e-9; s += 0.02) {
      go_to(s);
      devices.motors->drive(power);
    }
    go_to(to_s);
  }

  const Time begin = time_at_s(100.0);
  SteppedClock clock{begin};
  std::shared_ptr<Simulator> simulator;
  Devices devices;
};

/// The range of the beam nearest to a bearing.
inline double range_at(const Scan& scan, double bearing_rad) {
  const Beam* nearest = &scan.beams.front();
  for (const Beam& b : scan.beams) {
    if (std::abs(turn(b.angle_rad, bearing_rad)) < std::abs(turn(nearest->angle_rad, bearing_rad)))
      nearest = &b;
  }
  return nearest->range_m;
}

/// The middle one of the ranges within `half_rad` of a bearing: single beams get lost.
inline double median_range(const Scan& scan, double bearing_rad, double half_rad = radians(2.0)) {
  std::vector<float> ranges;
  for (const Beam& b : scan.beams) {
    if (std::abs(turn(b.angle_rad, bearing_rad)) <= half_rad) ranges.push_back(b.range_m);
  }
  std::nth_element(ranges.begin(), ranges.begin() + ranges.size() / 2, ranges.end());
  return ranges[ranges.size() / 2];
}

}  // namespace dynslam
