// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "device/wheels.h"
#include "drivers/gpio/encoders_config.h"
#include "drivers/gpio/lines.h"
#include "drivers/gpio/quadrature.h"

namespace dynslam {

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
class WheelEncoders : public Wheels {
 public:
  using OpenInputs = std::function<std::unique_ptr<InputLines>(std::span<const LineUse>)>;
  static constexpr Duration kPeriod = std::chrono::milliseconds(20);

  /// REQUIRES: config.has_encoders() and no problem(). `clock` must outlive this and run like life.
  WheelEncoders(const EncodersConfig& config, const Clock& clock);
  /// The same with lines from elsewhere.
  WheelEncoders(const EncodersConfig& config, const Clock& clock, OpenInputs open);

  /// Counts until a sample is due, every 20 ms, or until the robot's clock says `until`: then nothing. What
  /// fails is opened anew at the next call; where the robot was stays. Throws DeviceError.
  std::optional<OdometrySample> next(Time until) override;

  std::string about() const override;
  /// "illegal-steps", that cannot be: edges were lost. A few are noise, many mean that the wheels are too
  /// fast.
  Counters counters() const override;

 private:
  std::uint64_t illegal_steps() const;

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
