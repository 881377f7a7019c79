// SPDX-License-Identifier: MIT
#pragma once

#include "base/scan.h"
#include "sim/outbox.h"
#include "sim/random_stream.h"
#include "sim/ray_caster.h"
#include "sim/robot_body.h"

namespace dynslam {

/// An RPLIDAR A3 in the robot's middle: 10 turns a second of 1200 beams, each from where the robot is at its
/// time, counter-clockwise from -pi. Ranges carry noise; some beams get lost, on dark things and where they
/// graze; between two things, one behind the other, a beam may read a distance in between.
class LidarModel {
 public:
  LidarModel(Time begin, std::uint64_t seed);

  /// Measures the beams due in a step, while the robot moves from one pose to the other. REQUIRES: steps
  /// follow each other from `begin` on, and a whole number of beams falls into each.
  void step(Duration length, const BodyPose& at_begin, const BodyPose& at_end, const RayCaster& caster,
            Outbox<Scan>& out);
  /// What it measures along an angle while the robot stands at a pose; infinity: nothing.
  double range_m(const BodyPose& pose, double angle_rad, const RayCaster& caster);
  /// When the turn that is being measured will be due.
  Time next_due() const { return scan_.stamp + kTurn + kLatency; }

  static constexpr Duration kTurn = std::chrono::milliseconds(100);
  static constexpr Duration kLatency = std::chrono::milliseconds(6);
  static constexpr int kBeams = 1200;
  static constexpr double kMinRange_m = 0.2, kMaxRange_m = 25.0;

 private:
  double measured_m(const SpaceRay& ray, const RayCaster& caster);
  void begin_turn(Time stamp);

  Scan scan_;
  RandomStream random_;
  double previous_m_ = 0.0;  ///< what the beam before met, without noise
};

}  // namespace dynslam
