// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace dynslam {

/// Appends `value` with exactly `decimals` digits after the point, whatever the locale.
inline void append_fixed(std::string& text, double value, int decimals) {
  std::array<char, 400> digits;  // the largest double has 309 digits before the point
  const auto end = std::to_chars(digits.begin(), digits.end(), value, std::chars_format::fixed, decimals).ptr;
  text.append(digits.begin(), end);
}

/// The shortest text that reads back as the same double, whatever the locale: "0.02", "12", "1e-07", "nan".
inline std::string shortest_text(double value) {
  std::array<char, 40> digits;
  return {digits.begin(), std::to_chars(digits.begin(), digits.end(), value).ptr};
}

}  // namespace dynslam
