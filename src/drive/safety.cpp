// SPDX-License-Identifier: MIT
#include "drive/safety.h"

#include <algorithm>
#include <cmath>

#include "drive/words.h"

namespace dynslam {
namespace {

/// The robot speeds up again after each new scan, and is slowed down again: shown as one.
constexpr Duration kSlowedShown = std::chrono::milliseconds(300);

}  // namespace

Safety::Safety(const SafetyConfig& config, const BodyConfig& body, const ClearanceConfig& clearance)
    : config_(config),
      estop_(config),
      motors_(config),
      scans_(config),
      imu_(config),
      bumpers_(config),
      clearance_(body, clearance) {}

Finding Safety::clock(Time now) {
  const bool went_back = now_ && now < *now_;
  now_ = now;
  if (!went_back) return {};
  estop_.clock_went_back();
  motors_.clock_went_back();
  scans_.clock_went_back();
  imu_.clock_went_back();
  motion_ = {};
  slowed_ = {};
  clearance_.forget();
  seen_.reset();
  return {Cause::kClock, {Motion::kStop, "the clock ran backwards"}};
}

Decision Safety::decide(Time now, const SafetyInputs& in) {
  Decision decision;
  Finding& worst = decision.worst;
  const auto weigh = [&worst](const Finding& row) {
    if (row.verdict.motion > worst.verdict.motion) worst = row;
  };
  weigh(clock(now));
  weigh(estop_.update(now, in.pins, in.has_estop, in.clear_asked));
  weigh(stop_.update(in.stop_asked, in.clear_asked));
  weigh(motors_.update(now, in.motors, power_));
  const Finding imu = imu_.update(now, in.imu, in.has_imu, is_moving(twist_));
  if (imu.cause == Cause::kTilt) weigh(imu);
  weigh(scans_.update(now, in.scan));
  if (in.driver_missing) weigh({Cause::kDriver, {Motion::kStop, *in.driver_missing}});

  if (scans_.good() && scans_.good() != seen_) {
    seen_ = scans_.good();
    clearance_.see(*seen_, motion_);
  }
  const ClearWay way = clearance_.way(now, in.twist, motion_);
  weigh(bumpers_.update(now, in.pins, twist_, in.twist));
  weigh(obstacle(now, way, in.twist));
  weigh(imu);
  weigh(battery(in));
  const bool held = worst.verdict.motion >= Motion::kHold;
  decision.share = held ? 0.0 : std::min(way.share, careful_share(in));
  return decision;
}

Finding Safety::obstacle(Time now, const ClearWay& way, const Twist& twist) {
  if (way.share >= 1.0) {
    const bool lately = slowed_.cause == Cause::kObstacle && now - slowed_at_ < kSlowedShown;
    return lately && is_moving(twist) ? slowed_ : Finding{};
  }
  const char* where = twist.v_mps > 0.0 ? " ahead" : twist.v_mps < 0.0 ? " behind" : " beside";
  const Motion motion = way.share > 0.0 ? Motion::kSlow : Motion::kHold;
  Finding row{Cause::kObstacle, {motion, "obstacle " + fixed_text(way.distance_m, 2) + " m" + where}};
  if (motion == Motion::kSlow) {
    slowed_ = row;
    slowed_at_ = now;
  }
  return row;
}

Finding Safety::battery(const SafetyInputs& in) const {
  if (in.battery.brownout || in.battery_power < 1.0) {
    const std::string percent = fixed_text(100.0 * in.battery_power, 0);
    return {Cause::kBrownout,
            {Motion::kSlow, "battery or 5 V supply broke down under load: power cut to " + percent + " %"}};
  }
  if (in.battery.level == BatteryLevel::kRecharge)
    return {Cause::kBattery, {Motion::kSlow, "battery nearly empty: recharge it"}};
  return {};
}

/// Where something calls for care that the power limit does not see to.
double Safety::careful_share(const SafetyInputs& in) const {
  if (!imu_.is_lost() && in.battery.level != BatteryLevel::kRecharge) return 1.0;
  const double v = std::abs(in.twist.v_mps), w = std::abs(in.twist.w_radps);
  double share = 1.0;
  if (v > config_.slow_mps) share = config_.slow_mps / v;
  if (share * w > config_.slow_turn_radps) share = config_.slow_turn_radps / w;
  return share;
}

void Safety::driven(Time now, const Twist& twist, const WheelPower& power,
                    const std::optional<ImuSample>& imu) {
  motion_.add(now, twist, imu);
  twist_ = twist;
  power_ = power;
}

}  // namespace dynslam
