// SPDX-License-Identifier: MIT
#include "drive/speed_control.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr double kLeastGain = 0.5, kMostGain = 2.0;
constexpr double kLearns_s = 2.0;  ///< of steady motion
constexpr double kSteady_s = 0.4;  ///< until what is measured is about what is commanded
constexpr double kSmooth_s = 0.2;  ///< of the commands, to tell whether they are steady
constexpr double kSteadyShare = 0.15;
constexpr double kHeldBack = 0.9;  ///< wheels that are told less than this share of the command are
/// Answers beyond these say that something else is wrong.
constexpr double kLeastAnswer = 0.2, kMostAnswer = 5.0;
constexpr double kMoves = 0.4;  ///< of the wanted speed: the motion has begun
constexpr double kLetsGo_s = 0.15;
constexpr double kLongestStep_s = 0.2;

}  // namespace

void SpeedControl::Axis::learn(double s, double applied, double measured, const Limits& limits) {
  smooth_applied += std::min(1.0, s / kSmooth_s) * (applied - smooth_applied);
  const bool steady = std::abs(applied - smooth_applied) <= kSteadyShare * std::abs(applied);
  const bool held_back = std::abs(applied) < kHeldBack * std::abs(commanded) || applied * commanded <= 0.0;
  const bool tells = steady && !held_back && push == 0.0 && std::abs(applied) >= limits.learns_over;
  steady_s = tells ? steady_s + s : 0.0;
  if (steady_s < kSteady_s || !std::isfinite(measured)) return;
  const double answer = measured / applied;
  if (answer < kLeastAnswer || answer > kMostAnswer) {
    gain += s / kLearns_s * (1.0 - gain);
    return;
  }
  gain = std::clamp(gain + s / kLearns_s * (1.0 / answer - gain), kLeastGain, kMostGain);
}

double SpeedControl::Axis::correct(double s, double wanted, double applied, double measured,
                                   const Limits& limits) {
  learn(s, applied, measured, limits);
  const bool slow = wanted != 0.0 && std::abs(wanted) < limits.pushes_under;
  const bool moves = std::isfinite(measured) && measured * wanted > kMoves * wanted * wanted;
  const bool told = applied * wanted > 0.0;
  if (!slow || push * wanted < 0.0 || !std::isfinite(measured))
    push = 0.0;
  else if (moves)
    push = std::abs(push) < 0.01 * limits.most_push ? 0.0 : push * std::exp(-s / kLetsGo_s);
  else if (told)
    push =
        std::clamp(push + std::copysign(limits.push_per_s * s, wanted), -limits.most_push, limits.most_push);
  commanded = wanted * gain + push;
  return commanded;
}

Twist SpeedControl::correct(Time now, const Twist& wanted, const Twist& applied, const Twist& measured) {
  constexpr Limits kAhead{0.1, 0.15, 0.1, 0.1};
  constexpr Limits kTurning{0.3, 0.8, 1.0, 0.6};
  const double passed_s = now_ ? to_seconds(now - *now_) : 0.0;
  now_ = now;
  if (!is_finite(wanted) || !is_finite(applied)) {
    v_.push = w_.push = v_.steady_s = w_.steady_s = v_.commanded = w_.commanded = 0.0;
    return is_finite(wanted) ? wanted : Twist{};
  }
  const double s = std::clamp(passed_s, 0.0, kLongestStep_s);
  return {v_.correct(s, wanted.v_mps, applied.v_mps, measured.v_mps, kAhead),
          w_.correct(s, wanted.w_radps, applied.w_radps, measured.w_radps, kTurning)};
}

}  // namespace dynslam
