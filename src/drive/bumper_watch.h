// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "base/pin_state.h"
#include "base/twist.h"
#include "drive/finding.h"
#include "drive/safety_config.h"
#include "drive/stamped.h"

namespace dynslam {

/// A pressed bumper: what it touches lies where the robot was driving to, so it may drive back only. When it
/// was pressed at rest the thing is taken to be ahead. After a turn on the spot all but that turn is free.
class BumperWatch {
 public:
  explicit BumperWatch(const SafetyConfig& config) : timeout_(from_seconds(config.pins_timeout_s)) {}

  /// `driven` is what moves the robot now, `wanted` what is about to.
  Finding update(Time now, const std::optional<Stamped<PinState>>& pins, const Twist& driven,
                 const Twist& wanted);

 private:
  Duration timeout_;
  std::optional<Twist> into_;  ///< how it drove when the bumper was pressed; nothing: it is not
};

}  // namespace dynslam
