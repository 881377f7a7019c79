// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "base/number_text.h"
#include "base/time.h"

namespace dynslam {

/// "0.32"
inline std::string fixed_text(double value, int decimals) {
  std::string text;
  append_fixed(text, value, decimals);
  return text;
}

/// How long, for people: "0.4 s", and without the tenths from 10 s on.
inline std::string seconds_text(Duration d) {
  const double s = to_seconds(d);
  return fixed_text(s, s < 9.95 ? 1 : 0) + " s";
}

}  // namespace dynslam
