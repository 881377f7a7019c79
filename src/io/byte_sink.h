// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string_view>

namespace dynslam {

/// Where a writer puts its bytes, piece by piece and in order. May throw when they cannot be kept.
using ByteSink = std::function<void(std::string_view)>;

}  // namespace dynslam
