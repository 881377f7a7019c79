// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/access/role.h"

namespace dynslam {

/// Lets one in, once.
struct PairingCode {
  std::string text;  ///< as a person types it: "ABCD-2345"
  Role role = Role::kNone;
  bool makes_owner = false;
  std::chrono::steady_clock::time_point expires;
};

/// The codes that are out. A code is short, so that a person can type it; that is safe because it is never
/// on a disk, lasts only so long, works once, and guesses are slowed down (BackOff): 40 bits. Pure; the
/// caller locks.
class PairingCodes {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;
  static constexpr std::size_t kMost = 16;  ///< more push out the oldest invitation

  /// A new code.
  PairingCode add(Role role, bool makes_owner, SteadyTime expires);
  /// Takes the code that was typed out, if it is one. Compares with all, however early it matches.
  std::optional<PairingCode> take(std::string_view typed, SteadyTime now);
  /// After what it was taken for has failed.
  void put_back(PairingCode code) { codes_.push_back(std::move(code)); }

  /// The one that makes the owner.
  std::optional<PairingCode> for_owner(SteadyTime now) const;
  void drop_for_owner();

 private:
  void drop_expired(SteadyTime now);

  std::vector<PairingCode> codes_;  ///< the oldest first
};

}  // namespace dynslam
