// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/config_field.h"
#include "base/odometry.h"
#include "drivers/gpio/lines.h"
#include "drivers/gpio/quadrature.h"

namespace dynslam {

/// Section [encoders] of the configuration: a quadrature encoder on a wheel of each side. Up to some 2000
/// edges a second in all; faster ones take the kernel's rotary-encoder or a microcontroller.
struct EncodersConfig {
  std::string chip = "auto";
  int left_a_line = -1, left_b_line = -1;
  int right_a_line = -1, right_b_line = -1;
  bool left_reversed = false, right_reversed = true;
  double metres_per_step = 0.0005;
  double track_m = 0.3;

  bool has_encoders() const {
    return left_a_line >= 0 && left_b_line >= 0 && right_a_line >= 0 && right_b_line >= 0;
  }

  /// What is wrong with the values together, if anything.
  std::optional<std::string> problem() const;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    constexpr double kMostLine = 511;
    visit(Field{"chip", "the chip of the lines, as gpio.chip"}, self.chip);
    visit(Field{"left_a_line", "channel A of the left wheel, -1: none", -1, kMostLine}, self.left_a_line);
    visit(Field{"left_b_line", "channel B of the left wheel, -1: none", -1, kMostLine}, self.left_b_line);
    visit(Field{"right_a_line", "channel A of the right wheel, -1: none", -1, kMostLine}, self.right_a_line);
    visit(Field{"right_b_line", "channel B of the right wheel, -1: none", -1, kMostLine}, self.right_b_line);
    visit(Field{"left_reversed", "B leads while the left wheel turns forward"}, self.left_reversed);
    visit(Field{"right_reversed", "B leads while the right wheel turns forward"}, self.right_reversed);
    visit(Field{"metres_per_step", "way of a wheel for each of the four steps of a period", 1e-6, 1.0},
          self.metres_per_step);
    visit(Field{"track_m", "between the sides' wheels, as it counts when turning", 0.05, 3.0}, self.track_m);
  }
};

/// Where the wheels say the robot went. Each step is an arc, exactly.
class WheelOdometry {
 public:
  explicit WheelOdometry(double track_m) : track_m_(track_m) {}
  /// How far both sides rolled since the last call, metres.
  void roll(double left_m, double right_m);
  const Pose2& odom_T_robot() const { return odom_T_robot_; }

 private:
  double track_m_;
  Pose2 odom_T_robot_;
};

/// Two wheels' encoders on GPIO lines. Used by one thread.
class WheelEncoders {
 public:
  using OpenInputs = std::function<std::unique_ptr<InputLines>(std::span<const LineUse>)>;
  static constexpr Duration kPeriod = std::chrono::milliseconds(20);

  /// REQUIRES: config.has_encoders() and no problem(). `clock` must outlive this and run like life.
  WheelEncoders(const EncodersConfig& config, const Clock& clock);
  /// The same with lines from elsewhere.
  WheelEncoders(const EncodersConfig& config, const Clock& clock, OpenInputs open);

  /// Counts until a sample is due, every 20 ms, or until the robot's clock says `until`: then nothing. What
  /// fails is opened anew at the next call; where the robot was stays. Throws DeviceError.
  std::optional<OdometrySample> next(Time until);

  /// Steps that cannot be, ever: edges were lost. A few are noise, many mean that the wheels are too fast.
  std::uint64_t illegal_steps() const;

 private:
  struct Wheel {
    Quadrature counter;
    std::int64_t told = 0;  ///< of its count
  };

  void open();
  void count(Clock::SteadyTime until);
  double rolled_m(Wheel& wheel, bool reversed) const;

  EncodersConfig config_;
  const Clock& clock_;
  OpenInputs open_;
  WheelOdometry odometry_;
  std::array<Wheel, 2> wheels_;  ///< left, right
  std::array<LineEdge, 64> edges_;
  std::unique_ptr<InputLines> lines_;
  std::uint64_t illegal_before_ = 0;
  Time due_;
};

}  // namespace dynslam
