// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

namespace dynslam {

/// What somebody may do. Each may what the ones before may.
enum class Role {
  kNone,    ///< a stranger: asks whether the robot is alive, pairs, stops it
  kViewer,  ///< sees and hears what the robot does
  kDriver,  ///< drives it, sends it somewhere, clears a stop
  kAdmin,   ///< lets others in and throws them out
};

constexpr std::string_view to_string(Role role) {
  switch (role) {
    case Role::kNone:
      return "none";
    case Role::kViewer:
      return "viewer";
    case Role::kDriver:
      return "driver";
    case Role::kAdmin:
      return "admin";
  }
  return "?";
}

/// "viewer", "driver" or "admin"; nothing else can be given to anybody.
constexpr std::optional<Role> role_named(std::string_view name) {
  for (const Role role : {Role::kViewer, Role::kDriver, Role::kAdmin})
    if (name == to_string(role)) return role;
  return std::nullopt;
}

}  // namespace dynslam
