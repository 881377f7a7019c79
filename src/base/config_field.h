// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string_view>

namespace dynslam {

/// What a `struct ...Config` says of one of its fields, so that files, `--set` and the help text need no
/// second list. Each such struct has `template <class Self, class Visit> static void fields(Self& self,
/// Visit&& visit)` that calls `visit(Field{...}, self.member)` once for each member.
struct Field {
  std::string_view name;                                  ///< as in the TOML file, with its unit
  std::string_view doc;                                   ///< one line
  double min = -std::numeric_limits<double>::infinity();  ///< numbers only, inclusive
  double max = std::numeric_limits<double>::infinity();   ///< numbers only, inclusive
};

}  // namespace dynslam
