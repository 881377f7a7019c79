// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace dynslam {

/// Told which stage of a scan begins, so that a runtime can measure what the thinking, which knows no clock,
/// cannot.
class StageWatch {
 public:
  virtual ~StageWatch() = default;
  /// `stage` is a literal; an empty one ends the scan.
  virtual void enter(std::string_view stage) = 0;
};

}  // namespace dynslam
