// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "base/wall_time.h"
#include "server/access/role.h"
#include "server/access/secrets.h"

namespace dynslam {

/// What lets a browser or a program in. The secret itself is with its holder alone.
struct Credential {
  enum class Kind { kSession, kToken };

  std::string id;  ///< no secret
  Kind kind = Kind::kSession;
  std::string name;  ///< given by a person
  Role role = Role::kNone;
  Digest digest{};  ///< of the secret
  WallTime created, last_seen;
  bool seen_behind = false;  ///< since then, by a clock that was behind it; not kept
  bool operator==(const Credential&) const = default;
};

}  // namespace dynslam
