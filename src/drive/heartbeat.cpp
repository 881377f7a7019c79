// SPDX-License-Identifier: MIT
#include "drive/heartbeat.h"

#include "drive/words.h"

namespace dynslam {

Heartbeat::State Heartbeat::update(Time now, const std::optional<DriveCommand>& newest) {
  if (now < now_) {
    lose();
    last_heard_.reset();
  }
  now_ = now;
  if (newest && !is_known(*newest)) accept(*newest);
  if (last_ && last_->heard + timeout_ <= now) lose();
  if (!last_) return state_ = State::kSilent;
  if (last_->heard - steady_since_ < debounce_) return state_ = State::kUnsteady;
  if (!is_moving(last_->twist)) armed_ = true;
  return state_ = armed_ ? State::kAlive : State::kHeld;
}

void Heartbeat::driver_left() {
  lose();
  last_heard_.reset();
}

/// Commands are handed over newest first, the same one until there is another.
bool Heartbeat::is_known(const DriveCommand& command) const {
  return last_ && command.seq == last_->seq && command.heard == last_->heard;
}

void Heartbeat::accept(const DriveCommand& command) {
  if (const char* fault = fault_of(command)) {
    const bool counted = refusal_ && command.seq == refusal_->seq && command.heard == refusal_->heard;
    if (!counted) refused_.add(fault);
    refusal_ = command;
    return;
  }
  // A gap that no update() fell into is a loss all the same.
  if (last_ && last_->heard + timeout_ <= command.heard) lose();
  if (command.gone) return driver_left();
  if (!last_) steady_since_ = command.heard;
  last_ = command;
  last_heard_ = command.heard;
}

const char* Heartbeat::fault_of(const DriveCommand& command) const {
  if (command.heard > now_) return "command from the future";
  if (last_ && (command.seq <= last_->seq || command.heard < last_->heard)) return "command out of order";
  if (!is_finite(command.twist)) return "command not a number";
  return nullptr;
}

/// Also forgets the order of commands: another driver begins to count anew.
void Heartbeat::lose() {
  last_.reset();
  armed_ = false;
}

std::optional<Time> Heartbeat::deadline() const {
  if (!last_) return std::nullopt;
  return last_->heard + timeout_;
}

std::string Heartbeat::reason() const {
  switch (state_) {
    case State::kSilent:
      return last_heard_ ? "nothing heard from the driver for " + seconds_text(now_ - *last_heard_)
                         : "nobody is driving";
    case State::kUnsteady:
      return "waiting for the connection to the driver to be steady";
    case State::kHeld:
      return "let go of the stick, then push again";
    case State::kAlive:
      break;
  }
  return {};
}

}  // namespace dynslam
