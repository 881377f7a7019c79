// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "base/utf8_text.h"

namespace dynslam {

inline constexpr std::size_t kLongestRobotName = 40;
inline constexpr const char* kRobotNameRule = "must be 1 to 40 characters, none of them a control character";

/// Whether people can call the robot so.
inline bool is_robot_name(std::string_view text) {
  const auto characters = plain_characters(text);
  return characters && *characters >= 1 && *characters <= kLongestRobotName;
}

}  // namespace dynslam
