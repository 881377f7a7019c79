// SPDX-License-Identifier: MIT
#include "server/access/back_off.h"

#include <algorithm>

namespace dynslam {

BackOff::Seconds BackOff::wait(const IpAddress& address, SteadyTime now) {
  const bool is_known = by_holder_.contains(holder_of(address));
  Entry& entry = touch(address, now);
  if (!is_known && !address.is_loopback()) entry.next_guess = now + newcomer_wait(now);
  return std::max(Seconds(0), std::chrono::ceil<Seconds>(entry.next_guess - now));
}

void BackOff::failed(const IpAddress& address, SteadyTime now) {
  newcomer_wait(now);  // brings the level up to now
  level_ += 1.0;
  Entry& entry = touch(address, now);
  constexpr int kMostDoublings = 20;  // far beyond the cap
  const Seconds wait = kFirst * (1 << std::min(entry.failures++, kMostDoublings));
  entry.last_failure = now;
  entry.next_guess = now + std::min(wait, address.is_loopback() ? kLoopbackCap : kCap);
}

void BackOff::succeeded(const IpAddress& address) {
  const auto found = by_holder_.find(holder_of(address));
  if (found == by_holder_.end()) return;
  entries_.erase(found->second);
  by_holder_.erase(found);
}

BackOff::Entry& BackOff::touch(const IpAddress& address, SteadyTime now) {
  const IpAddress holder = holder_of(address);
  const auto found = by_holder_.find(holder);
  if (found != by_holder_.end()) {
    entries_.splice(entries_.begin(), entries_, found->second);
    Entry& entry = entries_.front();
    if (now - entry.last_failure >= kForgottenAfter) entry.failures = 0;
    return entry;
  }
  if (entries_.size() == kMost) {
    by_holder_.erase(entries_.back().holder);
    entries_.pop_back();
  }
  entries_.push_front({holder, 0, now, now});
  by_holder_[holder] = entries_.begin();
  return entries_.front();
}

/// Zero while it is calm; then a second more for each wrong guess.
BackOff::Seconds BackOff::newcomer_wait(SteadyTime now) {
  const std::chrono::duration<double> passed = now - level_at_;
  level_ = std::max(0.0, level_ - passed.count());
  level_at_ = now;
  const double above = std::clamp(level_ - kCalmGuesses, 0.0, static_cast<double>(kNewcomerCap.count()));
  return Seconds(static_cast<int>(above));
}

}  // namespace dynslam
