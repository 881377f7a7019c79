// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/pin_state.h"
#include "drive/finding.h"
#include "drive/safety_config.h"
#include "drive/stamped.h"

namespace dynslam {

/// The e-stop's button. The first reading that says pressed is believed; a person has to clear it, which
/// counts only when the button reads released and did so for a while.
class EStopLatch {
 public:
  explicit EStopLatch(const SafetyConfig& config)
      : release_(from_seconds(config.release_s)), timeout_(from_seconds(config.pins_timeout_s)) {}

  /// `pins` is the newest reading; `exists` says that there is a button, though it may never have been read.
  Finding update(Time now, const std::optional<Stamped<PinState>>& pins, bool exists, bool clear_asked);
  void clock_went_back();

 private:
  void take(const Stamped<PinState>& pins);

  Duration release_, timeout_;
  bool exists_ = false, latched_ = false, pressed_ = false;
  std::optional<Time> read_;            ///< the newest reading's stamp
  std::optional<Time> released_since_;  ///< by an unbroken row of readings
};

/// A stop that somebody asked for, kept until a person clears it.
class StopLatch {
 public:
  /// `asked` says who or why. Asked for and cleared at once, it stays.
  Finding update(const std::optional<std::string>& asked, bool clear_asked);

 private:
  std::optional<std::string> why_;
};

}  // namespace dynslam
