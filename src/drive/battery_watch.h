// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/battery_state.h"
#include "base/config_field.h"
#include "base/time.h"

namespace dynslam {

/// Section [battery] of the configuration. The defaults are for ten NiMH cells (12 V): they leave the charger
/// at 14 V, give 12.0 to 12.8 V for most of their charge, are nearly empty at 11 V and harmed under 9 V. The
/// computer's 5 V supply and the motor board need some 7 V; 10 V leave room for what is too short to be seen.
struct BatteryConfig {
  double full_v = 13.2;
  double good_over_v = 12.0;
  double low_under_v = 11.6;
  double low_over_v = 11.3;
  double recharge_under_v = 11.0;
  double empty_v = 10.5;
  double brownout_under_v = 10.0;
  double averaging_s = 10.0;
  double brownout_power = 0.7;
  double recovery_s = 10.0;

  /// What is wrong with the values together, if anything.
  std::optional<std::string> problem() const {
    const bool ordered = brownout_under_v <= empty_v && empty_v <= recharge_under_v &&
                         recharge_under_v < low_over_v && low_over_v <= low_under_v &&
                         low_under_v < good_over_v && good_over_v <= full_v && empty_v < full_v;
    if (ordered) return std::nullopt;
    return "battery: voltages must rise in the order brownout_under_v, empty_v, recharge_under_v, "
           "low_over_v, "
           "low_under_v, good_over_v, full_v";
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"full_v", "shown as full from here", 5.0, 36.0}, self.full_v);
    visit(Field{"good_over_v", "a low battery is good again from here", 5.0, 36.0}, self.good_over_v);
    visit(Field{"low_under_v", "a good battery is low under this", 5.0, 36.0}, self.low_under_v);
    visit(Field{"low_over_v", "an empty battery is only low again from here", 5.0, 36.0}, self.low_over_v);
    visit(Field{"recharge_under_v", "the battery must be charged under this", 5.0, 36.0},
          self.recharge_under_v);
    visit(Field{"empty_v", "shown as empty under this", 5.0, 36.0}, self.empty_v);
    visit(Field{"brownout_under_v", "even one reading under this cuts the power", 5.0, 36.0},
          self.brownout_under_v);
    visit(Field{"averaging_s", "time over which the voltage that is shown is averaged", 0.1, 600.0},
          self.averaging_s);
    visit(Field{"brownout_power", "what a brownout leaves of the power, 0 to 1", 0.1, 1.0},
          self.brownout_power);
    visit(Field{"recovery_s", "the power that brownouts took comes back over this time", 0.1, 600.0},
          self.recovery_s);
  }
};

/// Watches the battery's voltage. The level that is shown comes from an average, with hysteresis, as the
/// voltage dips with every start; a single reading that is too low for the computer is a brownout, told at
/// once, and costs power for a while (thesis, 3.1). So is a computer that says that its own supply is too
/// low, whatever the battery's voltage: between them stands a converter, and a cable.
class BatteryWatch {
 public:
  explicit BatteryWatch(const BatteryConfig& config = {}) : config_(config) {}

  /// Takes a reading, or says that there is none. What no battery can have (nothing, 0, not a number) is
  /// none. `supply_low`: so said the computer when it was asked last, about a second ago. Returns whether
  /// what is shown changed. A `now` before the last one begins a new measurement.
  bool update(Time now, std::optional<double> voltage_v, bool supply_low = false);

  /// What is shown: stays as it is until the level, the brownout or the share (by 5 %) changes.
  const BatteryState& shown() const { return shown_; }
  /// The average; nothing before there is a reading, and when there was none for 5 s.
  std::optional<double> voltage_v() const { return average_v_; }
  /// What brownouts leave of the power limit, 0 to 1.
  double power_share() const { return power_share_; }

 private:
  void average(double voltage_v, Duration passed);
  void cut_power(Duration every);
  void recover(Duration passed);
  bool is_brownout() const;
  BatteryLevel level() const;
  double share() const;
  bool show();

  BatteryConfig config_;
  BatteryState shown_;
  std::optional<Time> now_, last_reading_, last_brownout_, last_cut_;
  std::optional<double> average_v_;
  double measured_s_ = 0.0;  ///< how much time the average covers
  double power_share_ = 1.0;
};

}  // namespace dynslam
