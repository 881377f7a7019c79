// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace dynslam {

/// How far the robot may move, worse and worse. The worst of all reasons wins.
enum class Motion {
  kGo,
  kSlow,   ///< slower than asked for
  kHold,   ///< not in the direction asked for; other ways are open
  kStop,   ///< not at all, until the reason is gone
  kEStop,  ///< not at all, until a person clears it
};

constexpr const char* to_string(Motion m) {
  switch (m) {
    case Motion::kGo:
      return "go";
    case Motion::kSlow:
      return "slow";
    case Motion::kHold:
      return "hold";
    case Motion::kStop:
      return "stop";
    case Motion::kEStop:
      return "e-stop";
  }
  return "?";
}

/// What Safety decided, and why, in words that can be shown.
struct Verdict {
  Motion motion = Motion::kStop;
  std::string reason;
  bool operator==(const Verdict&) const = default;
};

}  // namespace dynslam
