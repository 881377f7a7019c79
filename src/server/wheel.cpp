// SPDX-License-Identifier: MIT
#include "server/wheel.h"

#include <algorithm>

namespace dynslam {

Wheel::Client Wheel::enter() {
  const std::lock_guard lock(mutex_);
  return ++clients_;
}

void Wheel::leave(Client client) {
  const std::lock_guard lock(mutex_);
  if (!lease_.release(client)) return;
  if (!is_hands_off()) command({}, true);
  steered_ = false;
}

bool Wheel::acquire(Client client, const std::string& name, bool take_over, SteadyTime now,
                    const std::string& id) {
  const std::lock_guard lock(mutex_);
  const DriverLease::Answer answer = lease_.acquire({client, name, id}, take_over, now);
  if (answer.relieved) {
    if (!is_hands_off()) command({}, true);
    steered_ = false;
  }
  return answer.granted;
}

void Wheel::release(Client client) { leave(client); }

void Wheel::touch(Client client, SteadyTime now) {
  const std::lock_guard lock(mutex_);
  lease_.renew(client, now);
}

bool Wheel::is_steered() const {
  const std::lock_guard lock(mutex_);
  return steered_;
}

std::optional<std::string> Wheel::order(Order order, const std::string& id, SteadyTime now) {
  const std::lock_guard lock(mutex_);
  const auto& holder = lease_.holder();
  if (steered_ && holder && holder->id != id && !lease_.is_idle(now)) return holder->name;
  steered_ = false;
  ports_.orders.push(std::move(order));
  return std::nullopt;
}

bool Wheel::is_hands_off() const {
  if (steered_) return false;
  const auto autopilot = ports_.autopilot.get().value;
  return (autopilot && autopilot->phase == AutopilotPhase::kActive) || (drives_itself_ && drives_itself_());
}

std::optional<Wheel::Sent> Wheel::drive(Client client, const Twist& wanted) {
  const std::lock_guard lock(mutex_);
  if (!lease_.holder() || lease_.holder()->client != client) return std::nullopt;
  if (wanted.v_mps != 0.0 || wanted.w_radps != 0.0) steered_ = true;
  if (is_hands_off()) return Sent{0, clock_.now()};
  return command({std::clamp(wanted.v_mps, -limits_.v_mps, limits_.v_mps),
                  std::clamp(wanted.w_radps, -limits_.w_radps, limits_.w_radps)},
                 false);
}

Wheel::Holder Wheel::holder(Client client) const {
  const std::lock_guard lock(mutex_);
  if (!lease_.holder()) return {};
  return {lease_.holder()->client == client, lease_.holder()->name};
}

std::optional<Wheel::Answered> Wheel::answered() {
  const std::lock_guard lock(mutex_);
  note_answered();
  return answered_;
}

Wheel::Delays Wheel::delays() {
  const std::lock_guard lock(mutex_);
  note_answered();
  return delays_;
}

/// A number no smaller than any that another commander may have used meanwhile.
Wheel::Sent Wheel::command(const Twist& twist, bool gone) {
  note_answered();
  if (const auto last = ports_.command.get().value) seq_ = std::max(seq_, last->seq);
  const Sent sent{++seq_, clock_.now()};
  ports_.command.put({sent.seq, twist, sent.heard, gone});
  if (gone) ports_.driver_left = true;  // which the next one's command may overtake
  return sent;
}

/// Each command counts once, the first time that its answer is seen.
void Wheel::note_answered() {
  const auto drive = ports_.drive.get().value;
  if (!drive || !drive->answered || drive->answered->seq > seq_) return;
  if (answered_ && drive->answered->seq <= answered_->seq) return;
  answered_ = Answered{drive->answered->seq, drive->driven - drive->answered->heard};
  (drive->answered->gone ? delays_.drop_to_off : delays_.command_to_motor).add(answered_->delay);
}

}  // namespace dynslam
