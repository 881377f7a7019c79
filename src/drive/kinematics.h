// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/config_field.h"
#include "base/motor_state.h"
#include "base/twist.h"

namespace dynslam {

/// Section [kinematics] of the configuration. The defaults are for a MonsterBorg.
struct KinematicsConfig {
  double max_speed_mps = 2.2;
  double max_turn_radps = 3.0;
  double track_width_m = 0.2;
  double turn_slip = 1.5;
  double deadband = 0.08;
  double turn_deadband = 0.08;
  double motor_rated_v = 12.0;
  double max_power = 0.95;
  double acceleration_mps2 = 1.0;
  double braking_mps2 = 2.0;
  double turn_acceleration_radps2 = 6.0;
  double turn_braking_radps2 = 12.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"max_speed_mps", "speed of the wheels at the motors' rated voltage", 0.05, 10.0},
          self.max_speed_mps);
    visit(Field{"max_turn_radps", "fastest turn that is commanded", 0.1, 20.0}, self.max_turn_radps);
    visit(Field{"track_width_m", "from the middle of the left wheels to that of the right ones", 0.03, 3.0},
          self.track_width_m);
    visit(Field{"turn_slip", "wheels that skid in turns act as if so many times as far apart", 1.0, 5.0},
          self.turn_slip);
    visit(Field{"deadband", "share of the rated voltage under which the wheels do not turn", 0.0, 0.5},
          self.deadband);
    visit(Field{"turn_deadband", "and so much more for turning on the spot, where all wheels skid", 0.0, 0.5},
          self.turn_deadband);
    visit(Field{"motor_rated_v", "what the motors get at most", 3.0, 36.0}, self.motor_rated_v);
    visit(Field{"max_power", "largest share of the battery's voltage; the computer needs the rest", 0.1, 1.0},
          self.max_power);
    visit(Field{"acceleration_mps2", "how fast the robot speeds up", 0.05, 20.0}, self.acceleration_mps2);
    visit(Field{"braking_mps2", "how fast it slows down when a driver asks for it", 0.05, 50.0},
          self.braking_mps2);
    visit(Field{"turn_acceleration_radps2", "how fast a turn speeds up", 0.1, 200.0},
          self.turn_acceleration_radps2);
    visit(Field{"turn_braking_radps2", "how fast a turn slows down", 0.1, 200.0}, self.turn_braking_radps2);
  }
};

/// From twists to the power of the wheels of a skid-steer robot. The speed of a wheel goes with the share of
/// the rated voltage that its motor gets, less a deadband that grows as the two sides differ and skid; the
/// power is that voltage as a share of the battery's. A battery of unknown voltage is taken for a freshly
/// charged one. All pure.
class Kinematics {
 public:
  explicit Kinematics(const KinematicsConfig& config = {}) : config_(config) {}

  /// The nearest twist on the same arc that the wheels can do.
  Twist reachable(const Twist& twist, std::optional<double> battery_v) const;
  /// What drives the robot like this; on the same arc but slower where the motors would get too much.
  /// Standing still is exactly zero, and so is what is not a number.
  WheelPower power(const Twist& twist, std::optional<double> battery_v) const;
  /// The most power a motor gets: not more than its rated voltage, nor than max_power.
  double most_power(std::optional<double> battery_v) const;

 private:
  struct WheelSpeeds {
    double left = 0.0, right = 0.0;  ///< m/s
  };
  WheelSpeeds speeds(const Twist& twist) const;
  double friction(const WheelSpeeds& speeds) const;
  double supply_v(std::optional<double> battery_v) const;
  double power_of_wheel(double speed_mps, double friction, double supply_v) const;
  double half_track_m() const { return 0.5 * config_.track_width_m * config_.turn_slip; }

  KinematicsConfig config_;
};

}  // namespace dynslam
