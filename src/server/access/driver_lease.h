// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace dynslam {

/// Who drives, of all that may: one at a time, until he lets go, is gone or says nothing for too long, or
/// another takes over and says so. Stopping needs no lease. That the robot stands still before it obeys
/// another driver is the caller's to see to (Heartbeat). Pure; the caller locks.
class DriverLease {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;
  using Client = std::uint64_t;  ///< a connection, not a person: two pages of one person are two

  /// From then on anybody may have the lease for asking.
  static constexpr std::chrono::seconds kIdleAfter{10};

  struct Holder {
    Client client = 0;
    std::string name;
    std::string id = {};  ///< of what let him in; of all his connections
    bool operator==(const Holder&) const = default;
  };
  struct Answer {
    bool granted = false;
    std::optional<Holder> relieved;  ///< who had it and is to be told
  };

  /// Asks for the lease; its holder renews it so.
  Answer acquire(const Holder& who, bool take_over, SteadyTime now) {
    const bool is_others = holder_ && holder_->client != who.client;
    if (is_others && !take_over && !is_idle(now)) return {};
    Answer answer{true, is_others ? holder_ : std::nullopt};
    holder_ = who;
    heard_at_ = now;
    return answer;
  }

  /// The client commands, or says that it is there; false when the lease is not its own.
  bool renew(Client client, SteadyTime now) {
    if (!holder_ || holder_->client != client) return false;
    heard_at_ = now;
    return true;
  }

  /// The client lets go or is gone; true when it had the lease.
  bool release(Client client) {
    const bool is_own = holder_ && holder_->client == client;
    if (is_own) holder_.reset();
    return is_own;
  }

  const std::optional<Holder>& holder() const { return holder_; }
  /// Whether nothing was heard of him for too long.
  bool is_idle(SteadyTime now) const { return now - heard_at_ >= kIdleAfter; }

 private:
  std::optional<Holder> holder_;
  SteadyTime heard_at_;
};

}  // namespace dynslam
