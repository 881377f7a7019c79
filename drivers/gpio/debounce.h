// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "base/time.h"

namespace dynslam {

/// Makes a clean signal of a contact that bounces: it is on once its level was on for `on_after` without a
/// break, and off likewise. The first level is believed at once.
class Debounce {
 public:
  Debounce(Duration on_after, Duration off_after) : on_after_(on_after), off_after_(off_after) {}

  /// Takes the level that holds from `t` on. A `t` before the last one counts as the last.
  void update(Time t, bool level) {
    if (!since_) {
      on_ = level_ = level;
      since_ = now_ = t;
    }
    now_ = std::max(now_, t);
    settle();
    if (level != level_) {
      level_ = level;
      since_ = now_;
      settle();
    }
  }

  bool on() const { return on_; }
  /// Whether it was on at any moment since this was asked last, however short.
  bool was_on() { return std::exchange(was_on_, on_) || on_; }

 private:
  void settle() {
    if (now_ - *since_ >= (level_ ? on_after_ : off_after_)) on_ = level_;
    was_on_ = was_on_ || on_;
  }

  Duration on_after_, off_after_;
  std::optional<Time> since_;  ///< the level is what it is
  Time now_;
  bool level_ = false, on_ = false, was_on_ = false;
};

}  // namespace dynslam
