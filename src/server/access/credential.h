// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

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
  std::chrono::sys_seconds created, last_seen;
  bool operator==(const Credential&) const = default;
};

}  // namespace dynslam
