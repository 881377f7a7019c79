// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/config_field.h"
#include "base/counters.h"
#include "base/drive_command.h"

namespace dynslam {

/// Section [heartbeat] of the configuration.
struct HeartbeatConfig {
  double timeout_s = 0.2;
  double debounce_s = 0.5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"timeout_s", "the motors stop when nothing was heard from the driver for so long", 0.05, 1.0},
          self.timeout_s);
    visit(Field{"debounce_s", "after a loss, the driver must be heard steadily for so long", 0.0, 10.0},
          self.debounce_s);
  }
};

/// The dead man's switch (thesis, 3.1). The driver is lost when nothing was heard for the timeout. After a
/// loss, and at the start, messages must keep coming for the debounce time, and then one must say "stand
/// still": so a stick that was held through the loss, or pushed before the robot could obey, does not start
/// it. A start always answers a push. What is refused is counted and is no sign of life. A driver who says
/// that he is gone is lost at once.
class Heartbeat {
 public:
  enum class State {
    kSilent,    ///< nothing was heard for the timeout
    kUnsteady,  ///< messages come again, but not for long enough
    kHeld,      ///< steady, but the driver has not let go of the stick yet
    kAlive,     ///< commands are obeyed
  };

  explicit Heartbeat(const HeartbeatConfig& config = {})
      : timeout_(from_seconds(config.timeout_s)), debounce_(from_seconds(config.debounce_s)) {}

  /// Takes the newest command; none, or the same one again, is fine. REQUIRES: `now` was read after `newest`
  /// was taken, as commands from the future are refused. A `now` before the last one counts as a loss.
  State update(Time now, const std::optional<DriveCommand>& newest);

  /// The driver is lost at once; whoever commands now begins anew.
  void driver_left();
  /// After this a held stick must be let go first, though the driver was never lost: the robot was stopped.
  void require_release() { armed_ = false; }

  State state() const { return state_; }
  /// What the driver wants; standing still unless kAlive.
  Twist wanted() const { return state_ == State::kAlive ? last_->twist : Twist{}; }
  /// When the driver will be lost if nothing more is heard; nothing when he is lost already.
  std::optional<Time> deadline() const;
  /// Why the robot does not obey, for the driver to read; empty when it does.
  std::string reason() const;

  /// Commands that were refused: "command from the future", "command out of order", "command not a number".
  const Counters& refused() const { return refused_; }

 private:
  void accept(const DriveCommand& command);
  bool is_known(const DriveCommand& command) const;
  /// What is wrong with it; null when nothing is.
  const char* fault_of(const DriveCommand& command) const;
  void lose();

  Duration timeout_, debounce_;
  State state_ = State::kSilent;
  Time now_ = Time::min();
  std::optional<DriveCommand> last_;     ///< accepted since the loss
  std::optional<DriveCommand> refusal_;  ///< the last one refused, to count it once
  std::optional<Time> last_heard_;       ///< ever
  Time steady_since_;
  bool armed_ = false;  ///< a command to stand still came since a start was last forbidden
  Counters refused_;
};

}  // namespace dynslam
