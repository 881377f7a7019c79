// SPDX-License-Identifier: MIT
#pragma once

namespace dynslam {

/// Ten NiMH cells in a row: their voltage falls as they are used, and sags under load.
class Battery {
 public:
  /// What is left, 0 to 1.
  void set_share(double share);
  double share() const { return share_; }
  void step(double current_a, double dt_s);
  double voltage_v() const;

  static constexpr double kCapacityAs = 2.1 * 3600;
  static constexpr double kResistance_ohm = 0.35;

 private:
  double share_ = 1.0;
  double current_a_ = 0.0;
};

}  // namespace dynslam
