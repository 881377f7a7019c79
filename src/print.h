// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace dynslam {

/// As printf; what goes beyond 399 characters is cut off.
template <class... Values>
std::string print(const char* form, Values... values) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), form, values...);
  return text.data();
}

}  // namespace dynslam
