// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/access/credential.h"

namespace dynslam {

/// All that lets somebody in. Pure; the caller locks.
class CredentialBook {
 public:
  static constexpr std::size_t kMost = 256;
  static constexpr std::size_t kLongestName = 64;  ///< bytes

  explicit CredentialBook(std::chrono::days session_lasts) : session_lasts_(session_lasts) {}

  bool is_full() const { return all_.size() >= kMost; }
  /// REQUIRES: not full.
  void add(Credential credential) { all_.push_back(std::move(credential)); }
  bool remove(const std::string& id);
  /// Those that expired; to make room. Otherwise they stay: the clock may be wrong.
  void drop_expired(WallTime now);

  /// Null when there is none, or it has expired. Compares with all, however early it matches.
  Credential* find(Credential::Kind kind, const Digest& digest, WallTime now);
  Credential* find(const std::string& id, WallTime now);
  /// Its holder is there. Returns whether there is something to keep.
  static bool see(Credential& credential, WallTime now);
  /// The clock says `now`, and knows no better what it said before. What was seen before this program was
  /// written was seen by a clock that was not set.
  void begin(WallTime now);
  /// The clock was put forward: what was seen by it is no older than before.
  void put_forward(WallTime from, WallTime to);
  bool has_admin(WallTime now) const;
  /// The oldest first.
  std::vector<Credential> all(WallTime now) const;

  /// As text for a file.
  std::string to_json() const;
  /// Takes what to_json() wrote in place of what there is. Throws InputError that says what is wrong with it,
  /// and then changes nothing.
  void read_json(std::string_view text);

 private:
  bool is_valid(const Credential& credential, WallTime now) const;

  std::chrono::days session_lasts_;
  std::vector<Credential> all_;  ///< the oldest first
};

/// Whether a text can name a person's device: 1 to 64 bytes of UTF-8 without control characters.
bool is_name(std::string_view text);

}  // namespace dynslam
