// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/time.h"
#include "base/twist.h"

namespace dynslam {

/// Makes a robot without wheel encoders drive what is asked: learns by how much the floor, the battery and
/// the skidding of the wheels falsify a command, from the IMU's yaw rate and SLAM's speed, and pushes harder
/// where a slow motion does not begin. Pure; one thread.
class SpeedControl {
 public:
  /// What to command, so that `wanted` is driven. `applied` is what the wheels were last told, after all
  /// limits; `measured` is how the robot moves, NaN where unknown. Called at 10 to 50 Hz; what is not a
  /// number is not learned from, and a wanted one is standing still.
  Twist correct(Time now, const Twist& wanted, const Twist& applied, const Twist& measured);
  /// What was learned: a command of 1 drives 1 / gain.
  Twist gain() const { return {v_.gain, w_.gain}; }
  void reset() { *this = {}; }

 private:
  /// In which range of speeds what is done. All in m/s or rad/s.
  struct Limits {
    double learns_over;   ///< commands that are faster tell
    double pushes_under;  ///< motions that are slower may not begin
    double push_per_s;    ///< harder and harder
    double most_push;
  };
  struct Axis {
    double gain = 1.0;
    double push = 0.0;
    double smooth_applied = 0.0;
    double steady_s = 0.0;   ///< how long the wheels were told about the same
    double commanded = 0.0;  ///< by the last correct()
    void learn(double s, double applied, double measured, const Limits& limits);
    double correct(double s, double wanted, double applied, double measured, const Limits& limits);
  };

  Axis v_, w_;
  std::optional<Time> now_;
};

}  // namespace dynslam
