// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

namespace dynslam {

struct BuiltinWorld {
  std::string_view name, toml;
};

/// The files of sim/worlds, put into the program when it is built.
std::span<const BuiltinWorld> builtin_worlds();

}  // namespace dynslam
