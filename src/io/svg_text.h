// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <string>
#include <string_view>

#include "base/number_text.h"
#include "base/pose2.h"

namespace dynslam {

/// The text of an SVG file as it grows; the same whatever the locale. Lengths are written to the hundredth,
/// without the zeros at the end: "12.5", "-3", "0".
class SvgText {
 public:
  SvgText& operator<<(std::string_view piece) {
    text_ += piece;
    return *this;
  }
  SvgText& operator<<(const char* piece) { return *this << std::string_view(piece); }
  SvgText& operator<<(char c) {
    text_ += c;
    return *this;
  }
  SvgText& operator<<(std::integral auto count) { return *this << std::to_string(count); }
  SvgText& operator<<(double length) {
    std::string digits;
    append_fixed(digits, length, 2);
    while (digits.ends_with('0')) digits.pop_back();
    if (digits.ends_with('.')) digits.pop_back();
    return *this << (digits == "-0" ? "0" : digits);
  }
  SvgText& operator<<(const Vector2& point) { return *this << point.x() << ' ' << point.y(); }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Words as they may stand between tags and in attributes. What is not printable ASCII becomes '?': a stray
/// byte would make the whole file unreadable.
inline std::string xml_text(std::string_view words) {
  std::string text;
  for (const char c : words) {
    switch (c) {
      case '<':
        text += "&lt;";
        break;
      case '>':
        text += "&gt;";
        break;
      case '&':
        text += "&amp;";
        break;
      case '"':
        text += "&quot;";
        break;
      case '\'':
        text += "&apos;";
        break;
      default:
        text += c >= ' ' && c <= '~' ? c : '?';
    }
  }
  return text;
}

}  // namespace dynslam
