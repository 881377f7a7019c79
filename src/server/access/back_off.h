// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <map>
#include <string_view>

#include "server/access/ip_address.h"

namespace dynslam {

/// How long who guesses must wait before the next guess is looked at. Pure; the caller locks.
///
/// - After each wrong guess an address waits twice as long as before, up to a cap; loopback never long.
/// - When many guesses are wrong, from wherever, also those who have not guessed yet must wait, once and
///   not long. Their turn is then kept for them, so nobody is locked out by what others do.
///
/// Holds the last kMost addresses, so that no more guesses are looked at than these allow for. Of IPv6, which
/// gives everybody many addresses, a subnet counts as one.
class BackOff {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;
  using Seconds = std::chrono::seconds;

  static constexpr std::size_t kMost = 1024;
  static constexpr Seconds kFirst{1}, kCap{300}, kLoopbackCap{1};
  static constexpr Seconds kForgottenAfter{3600};  ///< since the last wrong guess
  static constexpr double kCalmGuesses =
      30.0;  ///< wrong ones that are nothing special; one a second is forgotten
  static constexpr Seconds kNewcomerCap{10};

  /// Zero: a guess may be looked at now. Otherwise it must not be.
  Seconds wait(const IpAddress& address, SteadyTime now);
  void failed(const IpAddress& address, SteadyTime now);
  void succeeded(const IpAddress& address);

  std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    IpAddress holder;
    int failures = 0;
    SteadyTime last_failure, next_guess;
  };
  using Entries = std::list<Entry>;

  Entry& touch(const IpAddress& address, SteadyTime now);
  Seconds newcomer_wait(SteadyTime now);

  Entries entries_;  ///< the one heard of last comes first
  std::map<IpAddress, Entries::iterator> by_holder_;
  double level_ = 0.0;  ///< of wrong guesses, from anywhere
  SteadyTime level_at_;
};

}  // namespace dynslam
