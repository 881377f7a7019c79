// SPDX-License-Identifier: MIT
#include "drive/battery_watch.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Under this the board would not answer, over it its voltmeter ends: no battery's voltage.
constexpr double kLeast_v = 4.0;
constexpr double kMost_v = 36.5;

constexpr Duration kForgotten = seconds(5);        ///< without a reading, nothing is known any more
constexpr Duration kBrownoutShown = seconds(2);    ///< long enough to be seen
constexpr Duration kCutEvery = milliseconds(250);  ///< a cut takes so long to show in the voltage,
constexpr Duration kSupplyCutEvery = seconds(1);   ///< and so long in what the computer says
constexpr double kLeastPower = 0.2;
constexpr double kShownStep = 0.05;

}  // namespace

bool BatteryWatch::update(Time now, std::optional<double> voltage_v, bool supply_low) {
  if (now_ && now < *now_) {
    const double power = power_share_;
    *this = BatteryWatch(config_);
    power_share_ = power;
  }
  const Duration passed = now_ ? now - *now_ : Duration(0);
  now_ = now;
  recover(passed);
  if (voltage_v && std::isfinite(*voltage_v) && *voltage_v >= kLeast_v && *voltage_v <= kMost_v) {
    average(*voltage_v, last_reading_ ? now - *last_reading_ : Duration(0));
    if (*voltage_v < config_.brownout_under_v) cut_power(kCutEvery);
    last_reading_ = now;
  } else if (last_reading_ && now - *last_reading_ >= kForgotten) {
    average_v_.reset();
    last_reading_.reset();
  }
  if (supply_low) cut_power(kSupplyCutEvery);
  return show();
}

/// The mean of all readings at first, then one that forgets.
void BatteryWatch::average(double voltage_v, Duration passed) {
  if (!average_v_) {
    average_v_ = voltage_v;
    measured_s_ = 0.0;
    return;
  }
  const double step_s = std::max(to_seconds(passed), 1e-3);
  measured_s_ += step_s;
  const double memory_s = std::min(config_.averaging_s, measured_s_ + step_s);
  *average_v_ += std::min(1.0, step_s / memory_s) * (voltage_v - *average_v_);
}

/// No more often than a cut shows.
void BatteryWatch::cut_power(Duration every) {
  last_brownout_ = now_;
  if (last_cut_ && *now_ - *last_cut_ < every) return;
  power_share_ = std::max(std::min(kLeastPower, power_share_), power_share_ * config_.brownout_power);
  last_cut_ = now_;
}

void BatteryWatch::recover(Duration passed) {
  if (is_brownout()) return;
  power_share_ = std::min(1.0, power_share_ + to_seconds(passed) / config_.recovery_s);
}

bool BatteryWatch::is_brownout() const { return last_brownout_ && *now_ - *last_brownout_ < kBrownoutShown; }

BatteryLevel BatteryWatch::level() const {
  if (!average_v_) return BatteryLevel::kUnknown;
  const double v = *average_v_;
  if (v < config_.recharge_under_v) return BatteryLevel::kRecharge;
  if (shown_.level == BatteryLevel::kRecharge && v < config_.low_over_v) return BatteryLevel::kRecharge;
  if (v < config_.low_under_v) return BatteryLevel::kLow;
  const bool was_low = shown_.level == BatteryLevel::kLow || shown_.level == BatteryLevel::kRecharge;
  return was_low && v < config_.good_over_v ? BatteryLevel::kLow : BatteryLevel::kGood;
}

double BatteryWatch::share() const {
  if (!average_v_) return 0.0;
  return std::clamp((*average_v_ - config_.empty_v) / (config_.full_v - config_.empty_v), 0.0, 1.0);
}

bool BatteryWatch::show() {
  const BatteryLevel level = this->level();
  const double share = this->share();
  const bool brownout = is_brownout();
  const bool changed =
      level != shown_.level || brownout != shown_.brownout || std::abs(share - shown_.share) >= kShownStep;
  if (changed) shown_ = {average_v_.value_or(0.0), share, level, brownout};
  return changed;
}

}  // namespace dynslam
